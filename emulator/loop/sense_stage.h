#pragma once
// The loop's second stage: turns a rendered frame into digital numbers as the sensor does, applies image
// faults, and hands the frame to every output, at the earliest when the exposure has ended.
//
// For a recording, it keeps what the frame depends on (frame_script.h) and which commands it shows, right
// before publishing it.

#include <atomic>
#include <cstdint>
#include <vector>

#include "emulator/loop/frame_slot.h"
#include "emulator/loop/loop_figures.h"
#include "emulator/loop/loop_parts.h"
#include "io/contract/frame_sink.h"
#include "render/vocabulary/image.h"
#include "sensor/auto_exposure.h"
#include "sensor/camera_model.h"
#include "sensor/chain.h"

namespace hilcam {

class SenseStage {
  public:
    // Allocates everything that run() needs. figures: must outlive the stage. Owner thread.
    SenseStage(const LoopParts& parts, LoopFigures& figures);

    // Senses and publishes the slot's frame. Returns false, without a frame, when `stopping` becomes true
    // before the exposure has ended. Loop, one thread.
    bool run(FrameSlot& slot, const std::atomic<bool>& stopping);

  private:
    void sense(FrameSlot& slot);
    void measure_exposure(FrameSlot& slot);
    void finish_picture(const FrameSlot& slot);
    bool wait_for_end(const FrameSlot& slot, const std::atomic<bool>& stopping) const;
    void wait_for_room();
    void know_machine_times(FrameSlot& slot) const;
    void keep(const FrameSlot& slot);
    void publish(FrameSlot& slot);

    SensorChain& chain_;
    const CameraModel& camera_;
    FaultBoard& faults_;
    const SimulatedClock& clock_;
    std::vector<FrameSink*> sinks_;
    std::uint64_t seed_;
    bool replays_, loses_none_;
    FrameRecorder* recorder_;
    std::uint16_t recorded_camera_;
    std::vector<std::uint64_t> recorded_shown_;  // by thing: newest command that a recorded frame shows
    LoopCounters& counters_;
    StageMeters& meters_;
    ElectronImage electrons_;
    DnImage frame_, before_;    // the frame in work, and the previously published one
    FrameHistogram histogram_;  // for automatic exposure
    std::int64_t last_published_ns_ = 0;
};

}  // namespace hilcam
