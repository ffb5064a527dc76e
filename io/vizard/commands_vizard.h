#pragma once
// Pictures for Basilisk's vizInterface in Vizard's place: the simulator tells the world and asks for images
// (ZeroMQ, REQ there, REP here); each image is one `expose` in lockstep. docs/vizard.md.
//
// Nothing is authenticated: bind to loopback, or to a network of the bench alone. By TCP there are 200
// connections at most, and a message above 16 MiB or 1000 parts ends its own (zmq_frontend.h). Several
// simulators may be connected; each request is answered in its turn, and all speak of the same world.

#include <memory>
#include <vector>

#include "io/contract/command_receiver.h"
#include "io/vizard/vizard_sink.h"
#include "io/vizard/vizard_world.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// The way in which a frame's numbers become a PNG's. kDeep: 16 bits, the number in the most significant ones;
// kBytes: its upper 8 bits, as readers of 8 bits take them from the other. A camera with a mosaic gives
// interpolated colours of 8 bits.
enum class VizardDepth { kDeep, kBytes };

struct VizardConfig {
    std::string address = "tcp://127.0.0.1:5556";
    VizardDepth depth = VizardDepth::kDeep;
    VizardTime time = VizardTime::kMessage;
    double tolerance_rad = 0.1 * kDegree_rad;
    bool stay = false;
    std::vector<VizardCameraConfig> cameras{};
};
Fields fields(VizardConfig& config);
void validate(const VizardConfig& config);

// A camera that takes pictures for it: where its frames come, and how they are read.
struct VizardCameraPart {
    VizardSink* sink = nullptr;   // outlives the receiver
    std::string color_pattern{};  // colour pattern as in CameraLimits
};

// `remark` may be called from the receiver's thread. `handler` outlives the receiver.
std::unique_ptr<CommandReceiver> make_vizard_receiver(const VizardConfig& config, VizardBench bench,
                                                      std::vector<VizardCameraPart> cameras,
                                                      CommandHandler& handler, VizardWorld::Remark remark);

}  // namespace hilcam
