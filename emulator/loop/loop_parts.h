#pragma once
// The parts of a frame loop: those of its camera, its limits, the source of its frames, and the observers of
// its frames. Everything it refers to must outlive the loop.

#include <cstdint>
#include <vector>

#include "emulator/loop/frame_recorder.h"
#include "emulator/loop/frame_script.h"
#include "emulator/loop/governor.h"
#include "emulator/scenario/quality_ladder.h"
#include "emulator/world/frame_watcher.h"
#include "emulator/world/pose_watch.h"

namespace hilcam {

struct CameraModel;
class ExposureRenderer;
class FaultBoard;
class FrameSink;
class LightPartOrders;
class LiveSettings;
class SensorChain;
class SimulatedClock;
class TruthSink;
class WorldState;

struct LoopLimits {
    std::uint64_t frames = 0;   // 0: no limit
    std::uint64_t warm_up = 0;  // first frames, for which times are not kept
    bool paced = true;          // false: as fast as possible, for benchmarks
    GovernorSettings governor{};
    LoopPreference prefer = LoopPreference::kThroughput;
    std::uint64_t counts_from_frame = 1;  // the first exposure that loop.fail_on counts when it is missed
};

// Any of these may be null. None of them changes a frame.
struct LoopObservers {
    FrameWatcher* watcher = nullptr;         // receives what each frame has seen of the world
    TruthSink* truth = nullptr;              // one of the sinks: receives the truth of frames
    LightPartOrders* light_parts = nullptr;  // says which frames to split into parts of light
    FrameRecorder* recorder = nullptr;       // keeps the data from which each frame was made
    std::uint16_t recorded_camera = 0;       // the camera's number in the recording, from 1
};

struct LoopParts {
    ExposureRenderer& exposures;
    SensorChain& chain;
    const CameraModel& camera;
    WorldState& world;
    LiveSettings& settings;
    FaultBoard& faults;
    SimulatedClock& clock;
    const PoseWatch* poses = nullptr;  // null: poses are not watched
    std::vector<FrameSink*> sinks{};
    std::uint64_t seed = 1;
    LoopLimits limits{};
    FrameScript* script = nullptr;  // dictates the frames; null: the loop plans them itself
    LoopObservers observers{};
};

}  // namespace hilcam
