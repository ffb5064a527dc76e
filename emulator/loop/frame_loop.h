#pragma once
// THE loop: pose -> radiance -> electrons -> DN -> sinks, frame after frame.
//
// Each of two threads runs a stage: one samples the world and renders (render_stage.h), the other senses and
// publishes (sense_stage.h). Both use oneTBB's threads inside. Frames pass through two slots that are
// allocated before the start (frame_slot.h); semaphores hand them over. loop.prefer:
//   throughput  the next frame is rendered while one is sensed, so the longer stage sets the frame rate
//   latency     the next frame waits until this one is out. Each stage has all threads to itself, so a frame
//               takes less time, but the sum of both stages sets the frame rate
// Pixels are the same in both. frame_planner.h decides when frames begin and what each depends on.
//
// After start() the two threads neither allocate, lock nor log, except for what Embree does inside
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
    // Any thread, also several at a time.
    void stop() noexcept;
    // True when the loop has been stopped or has published all frames that it was to make.
    bool finished() const { return finished_.load(); }

    const SimulatedClock& clock() const { return clock_; }
    const LoopCounters& counters() const { return figures_.counters; }
    const StageMeters& meters() const { return figures_.meters; }
    // Returns the exposures that were not made; read it when the loop is stopped.
    const MissedExposures& missed() const { return figures_.missed; }
    // Takes the oldest change that has not been taken; false when there is none. One thread.
    bool take_level_change(LevelChange& change) noexcept { return render_.take_level_change(change); }
    // Returns figures of the last rendered frame. For benchmarks, when the loop is stopped.
    const RenderStats& render_stats() const { return render_.stats(); }
    // The processor time of all threads of the program, and the part of those that work ahead (AheadThread).
    struct ProcessorTime {
        std::int64_t all_ns = 0, ahead_ns = 0;

        static ProcessorTime now();
    };
    // Returns the time as it was after the last warm-up frame. For benchmarks, when the loop is stopped.
    const ProcessorTime& warm_processor_time() const { return warm_processor_time_; }

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
    ProcessorTime warm_processor_time_;
    std::int64_t counted_processor_ns_ = 0;  // processor time when the newest frame was counted; 0: none yet
    std::atomic<bool> stopping_{false}, finished_{false};
    std::mutex joining_;  // guards the joining of threads, as several may call stop()
    std::thread render_thread_, sense_thread_;
};

}  // namespace hilcam
