#pragma once
// THE loop: pose -> radiance -> electrons -> DN -> sinks, frame after frame.
//
// Two threads, each a stage: one samples the world and renders (render_stage.h), the other senses and
// publishes (sense_stage.h). Both use oneTBB's threads inside. Frames pass through two slots allocated before
// the start (frame_slot.h); hand-over is by semaphores. loop.prefer:
//   throughput  while a frame is sensed the next one is rendered: frames come as fast as the longer stage
//               goes
//   latency     the next one waits until it is out: each stage has all threads to itself, so a frame is
//               through sooner; frames come as fast as both stages together go
// Pixels are the same in both. When frames begin and what each depends on is said in frame_planner.h.
//
// After start() both threads neither allocate nor lock nor log, but for what Embree does inside
// rtcCommitScene.

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <semaphore>
#include <thread>

#include "emulator/loop/frame_slot.h"
#include "emulator/loop/loop_figures.h"
#include "emulator/loop/loop_parts.h"
#include "emulator/loop/render_stage.h"
#include "emulator/loop/sense_stage.h"

namespace hilcam {

class FrameLoop {
  public:
    explicit FrameLoop(const LoopParts& parts);
    ~FrameLoop() { stop(); }

    void start();
    // Any thread, more than one at a time, too.
    void stop() noexcept;
    // True when it has been stopped, or has published all the frames that it was to take.
    bool finished() const { return finished_.load(); }

    const SimulatedClock& clock() const { return clock_; }
    const LoopCounters& counters() const { return figures_.counters; }
    const StageMeters& meters() const { return figures_.meters; }
    // One thread. False: there is none that was not taken yet.
    bool take_level_change(LevelChange& change) noexcept { return render_.take_level_change(change); }
    // Those of the frame rendered last; for benchmarks, when the loop is stopped.
    const RenderStats& render_stats() const { return render_.stats(); }
    // Returns what processor_ns() was after the last frame of warming up; likewise.
    std::int64_t warm_processor_ns() const { return warm_processor_ns_; }

  private:
    FrameSlot& slot_of(std::uint64_t turn) { return slots_[turn % slots_.size()]; }
    void render_frames();
    void sense_frames();
    void count_frame(std::uint32_t level);

    const SimulatedClock& clock_;
    LoopLimits limits_;
    LoopFigures figures_;
    RenderStage render_;
    SenseStage sense_;
    std::array<FrameSlot, 2> slots_;
    std::counting_semaphore<> free_, rendered_{0};
    std::int64_t warm_processor_ns_ = 0;
    std::int64_t counted_processor_ns_ = 0;  // when the newest frame was counted; 0: there was none
    std::atomic<bool> stopping_{false}, finished_{false};
    std::mutex joining_;  // for who stops it
    std::thread render_thread_, sense_thread_;
};

}  // namespace hilcam
