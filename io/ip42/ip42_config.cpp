// The keys of commands.ip42.

#include "io/ip42/commands_ip42.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "render/vocabulary/attitude.h"
#include "render/vocabulary/check.h"

namespace hilcam {

Fields fields(Ip42Config& c) {
    return {
        choice("role", c.role, {"client", "server"},
               "side of the connection. client: hilcam connects to 42 (SERVER in Inp_IPC.txt); server: 42 "
               "connects to hilcam (CLIENT)"),
        text("address", c.address,
             "IPv4 address. client: that of 42's machine; server: that of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "TCP port"),
        allow_field(c.allow),
        number("hold_ms", c.hold_s, 1e-3, {1, 600'000},
               "longest time for which 42 waits for the acknowledgement of a step. In lockstep it comes when "
               "the frame is done or after this time; in other modes at once"),
        integer("steps_per_frame", c.steps_per_frame, {1, 1'000'000'000},
                "steps of 42 from one frame to the next in lockstep; the first step makes a frame"),
        numbers("pole_deg", c.pole_rad, kDegree_rad, {-360, 360}, {2, 2},
                "right ascension and declination of the pole of 42's frame N at another world than the "
                "Earth; left out: N has ICRF axes"),
        number("tolerance_deg", c.tolerance_rad, kDegree_rad, {0, 180},
               "angle above which a remark is made, between 42's Sun and the scenario's, and between a body "
               "and a turn about its joint's axis"),
        flag("stay", c.stay,
             "treatment of 42's end. true: the program continues and waits for 42 again; false: it ends"),
        sections("bodies", c.bodies, "table of bodies of 42 and the things that they move"),
    };
}

void validate(const Ip42Config& c) {
    parse_ipv4(c.address, "address");
    if (c.role == Ip42Role::kServer)
        AllowList(c.allow, c.address, "commands.ip42");
    else if (!c.allow.empty())
        throw KeyError("allow", "has no effect with 'role: client'");
    if (c.bodies.empty())
        throw KeyError("bodies", "moves nothing: give '[{body: SC[0].B[0], moves: camera}]', or more");
}

// A2C(312, ra + 90 deg, 90 deg - dec, 0) takes ICRF axes to N (Source/42init.c); this is its inverse.
Mat3d icrf_from_n(const std::vector<double>& pole_rad) {
    if (pole_rad.empty()) return {};
    const Quat turn = from_euler({3, 1, 2}, {pole_rad[0] + kPi / 2, kPi / 2 - pole_rad[1], 0});
    return to_matrix(turn);
}

}  // namespace hilcam
