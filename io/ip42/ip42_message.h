#pragma once
// The text that 42 (Eric Stoneking, NASA GSFC; github.com/ericstoneking/42) writes to its socket after each
// step: lines "NAME = VALUES", and the end of the message. Facts from Source/AutoCode/TxRxIPC.c and
// Include/42types.h as of March 2025.
//
//    TIME 2026-079-06:00:00.100000000                    UTC, day of the year from 1
//    SC[0].qn = [x y z w]                                attitude of body 0: from its axes to those of N
//    SC[0].wn = [x y z]                                  rate of body 0 in N, in its axes [rad/s]
//    SC[0].PosR = [x y z], SC[0].VelR = [x y z]          centre of mass from the reference orbit, N [m, m/s]
//    SC[0].svb = [x y z]                                 direction of the Sun in the axes of body 0
//    SC[0].B[1].wn = [x y z], SC[0].B[1].qn = [x y z w]  the same of any body
//    Orb[0].PosN = [x y z], Orb[0].VelN = [x y z]        reference orbit from the centre of its world, N
//    [ENDMSG]                                            end; until 2024 and in NOS3's branch: [EOF]
//
// 42 then waits for the four bytes "Ack\0". Which lines come is chosen by the prefixes of Inp_IPC.txt. Other
// lines are skipped and counted.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "render/vocabulary/pose.h"

namespace hilcam {

// Bodies and spacecraft are numbered from 0, as in 42.
struct Ip42BodyState {
    std::optional<Quat> n_from_body;
    std::optional<Vec3d> rate_body_rad_s;
};
struct Ip42Spacecraft {
    std::optional<Vec3d> position_r_m, velocity_r_m_s;
    std::optional<Vec3d> sun_body_dir;  // axes of body 0
    std::map<std::int64_t, Ip42BodyState> bodies;
};
struct Ip42Orbit {
    std::optional<Vec3d> position_n_m, velocity_n_m_s;
};
struct Ip42Message {
    TimeTai time;
    std::map<std::int64_t, Ip42Spacecraft> spacecraft;
    std::map<std::int64_t, Ip42Orbit> orbits;
    std::uint64_t skipped_lines = 0;  // lines of other names
};

struct DecodedIp42 {
    Ip42Message message;
    std::string refusal;  // empty: no refusal; else one line: what, found, accepted
};

// Decodes the lines before the end of a message. Refuses a message without TIME, and one with a line of a
// name above whose values are not finite numbers, or no rotation. Any thread.
DecodedIp42 decode_ip42(std::string_view text);

// A body's place in 42: "SC[0].B[1]".
struct Ip42BodyName {
    std::int64_t spacecraft = 0, body = 0;
};
std::optional<Ip42BodyName> ip42_body_name(std::string_view text);

}  // namespace hilcam
