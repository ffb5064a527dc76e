#pragma once
// Takes Vizard's place for Basilisk's vizInterface. The simulator sends its world and asks for images
// (ZeroMQ, REQ there, REP here); each image is one `expose` in lockstep. docs/vizard.md.
//
// Nothing is authenticated: bind to loopback, or to a network with nothing but the bench. Over TCP, at most
// 200 connections are accepted, and a message above 16 MiB or 1000 parts ends its connection
// (zmq_frontend.h). Several simulators may be connected; requests are answered in turn, and all simulators
// act on the same world.

#include <memory>
#include <vector>

#include "io/contract/command_receiver.h"
#include "io/vizard/vizard_sink.h"
#include "io/vizard/vizard_world.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// The way in which a frame becomes a PNG. kDeep: 16 bits, with the DN in the most significant bits. kBytes: 8
// bits, the upper 8 of kDeep. A camera with a colour filter array gives interpolated colours of 8 bits.
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

// A camera that takes pictures for the simulator: where its frames arrive, and their colours.
struct VizardCameraPart {
    VizardSink* sink = nullptr;   // outlives the receiver
    std::string color_pattern{};  // CameraLimits::color_pattern
};

// remark: may be called on the receiver's thread. handler: outlives the receiver.
std::unique_ptr<CommandReceiver> make_vizard_receiver(const VizardConfig& config, VizardBench bench,
                                                      std::vector<VizardCameraPart> cameras,
                                                      CommandHandler& handler, VizardWorld::Remark remark);

}  // namespace hilcam
