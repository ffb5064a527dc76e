// The keys of commands.vizard: the same with ZeroMQ and protobuf and without.

#include "io/vizard/commands_vizard.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

Fields fields(VizardConfig& c) {
    return {
        text("address", c.address, "ZeroMQ endpoint to listen on: tcp://ADDRESS:PORT or ipc://PATH"),
        choice("depth", c.depth, {"16_bits", "8_bits"},
               "bit depth of the PNG pictures; 16_bits: the DN is in the upper bits, so 8-bit readers see "
               "the same picture"),
        choice("time", c.time, {"message", "scenario"},
               "start time of a run: the epoch of the first message, or time_utc"),
        number("tolerance_deg", c.tolerance_rad, kDegree_rad, {0, 180},
               "angle between a body's place in the messages and in the scenario's ephemerides above which a "
               "remark is made"),
        flag("stay", c.stay,
             "treatment of the simulator's request to end Vizard (terminateVizard). true: the program "
             "continues; false: it ends"),
        sections(
            "cameras", c.cameras,
            "table of cameras of the simulator and of the bench; left out: in the order of the messages"),
    };
}

void validate(const VizardConfig& c) {
    if (!c.address.starts_with("tcp://") && !c.address.starts_with("ipc://"))
        throw refused("address", in_quotes(c.address), "tcp://ADDRESS:PORT, ipc://PATH");
    for (std::size_t i = 0; i < c.cameras.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (c.cameras[i].id == c.cameras[j].id)
                throw InputError("cameras: id " + std::to_string(c.cameras[i].id) + " is there twice");
}

}  // namespace hilcam
