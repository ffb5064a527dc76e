// The keys of commands.vizard: the same with ZeroMQ and protobuf and without.

#include "io/vizard/commands_vizard.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

Fields fields(VizardConfig& c) {
    return {
        text("address", c.address, "ZeroMQ endpoint to listen at: tcp://ADDRESS:PORT or ipc://PATH"),
        choice(
            "depth", c.depth, {"16_bits", "8_bits"},
            "of the PNG pictures; 16_bits: the number in the upper ones, so that readers of 8 bits see the "
            "same"),
        choice("time", c.time, {"message", "scenario"},
               "where a run begins: at the epoch of its first message, or at time_utc"),
        number("tolerance_deg", c.tolerance_rad, kDegree_rad, {0, 180},
               "a body further than this from the scenario's ephemerides is remarked on"),
        flag("stay", c.stay, "goes on when the simulator tells Vizard to end (terminateVizard)"),
        sections("cameras", c.cameras, "which camera is which; none: in the messages' order"),
    };
}

void validate(const VizardConfig& c) {
    if (!c.address.starts_with("tcp://") && !c.address.starts_with("ipc://"))
        throw InputError("address: found " + in_quotes(c.address) +
                         "; accepted: tcp://ADDRESS:PORT, ipc://PATH");
    for (std::size_t i = 0; i < c.cameras.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (c.cameras[i].id == c.cameras[j].id)
                throw InputError("cameras: id " + std::to_string(c.cameras[i].id) + " is there twice");
}

}  // namespace hilcam
