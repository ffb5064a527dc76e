#pragma once
// The loop's second stage: turns a rendered frame into digital numbers as the sensor does, damages the
// picture where that is ordered, and hands it to every output, not before the exposure is over.
//
// Recordings: what the frame depends on (frame_script.h) and which commands it shows is kept right before it
// is published.

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
    // Allocates all that run() needs. figures: outlive the stage. Owner thread.
    SenseStage(const LoopParts& parts, LoopFigures& figures);

    // Senses and publishes the slot's frame; false when `stopping` before the camera was over with it: then there is none.
    // Loop, one thread.
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
    std::vector<std::uint64_t> recorded_shown_;  // by thing: the newest command that a kept frame shows
    LoopCounters& counters_;
    StageMeters& meters_;
    ElectronImage electrons_;
    DnImage frame_, before_;    // the one being finished, and the one published before it
    FrameHistogram histogram_;  // for automatic exposure
    std::int64_t last_published_ns_ = 0;
};

}  // namespace hilcam
