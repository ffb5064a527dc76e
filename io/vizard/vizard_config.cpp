// The keys of commands.vizard: the same with ZeroMQ and protobuf and without.

#include "io/vizard/commands_vizard.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

Fields fields(VizardConfig& c) {
    return {
        text("address", c.address, "ZeroMQ endpoint to listen at: tcp://ADDRESS:PORT or ipc://PATH"),
        choice("depth", c.depth, {"16_bits", "8_bits"},
               "depth of the PNG pictures; 16_bits: the number is in the upper bits, so that readers of 8 "
               "bits see the same"),
        choice("time", c.time, {"message", "scenario"},
               "instant at which a run begins: the epoch of its first message, or time_utc"),
        number("tolerance_deg", c.tolerance_rad, kDegree_rad, {0, 180},
               "angle from the scenario's ephemerides beyond which a body's place is remarked on"),
        flag("stay", c.stay,
             "true: the program goes on when the simulator tells Vizard to end (terminateVizard)"),
        sections("cameras", c.cameras,
                 "table of the simulator's cameras and the bench's; left out: in the messages' order"),
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
