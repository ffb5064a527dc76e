// Stands in for ZeroMQ and protobuf where hilcam is built without them (HILCAM_VIZARD=OFF).

#include "io/vizard/commands_vizard.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<CommandReceiver> make_vizard_receiver(const VizardConfig& config, VizardBench,
                                                      std::vector<VizardCameraPart>, CommandHandler&,
                                                      VizardWorld::Remark) {
    throw InputError(
        "commands.vizard.address " + config.address +
        ": this hilcam was built without Vizard's protocol; build it with -DHILCAM_VIZARD=ON, ZeroMQ and "
        "protobuf");
}

}  // namespace hilcam
