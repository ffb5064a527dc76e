#pragma once
// The parts that a frame loop is made of: those of its camera, how long and how it runs, who dictates its frames,
// and who is told of them. All that is referred to outlives the loop.

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
    std::uint64_t warm_up = 0;  // first frames, whose times are not kept
    bool paced = true;          // false: as fast as it goes, for benchmarks
    GovernorSettings governor{};
    LoopPreference prefer = LoopPreference::kThroughput;
};

// Each may be null. They change no frame.
struct LoopObservers {
    FrameWatcher* watcher = nullptr;         // is told what each frame has seen of the world
    TruthSink* truth = nullptr;              // one of the sinks, which is told what frames show
    LightPartOrders* light_parts = nullptr;  // says which frames are taken apart for somebody
    FrameRecorder* recorder = nullptr;       // keeps what each frame was made with
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
    const PoseWatch* poses = nullptr;  // null: nobody watches them
    std::vector<FrameSink*> sinks{};
    std::uint64_t seed = 1;
    LoopLimits limits{};
    FrameScript* script = nullptr;  // says which frames there are; null: the loop finds them by itself
    LoopObservers observers{};
};

}  // namespace hilcam
