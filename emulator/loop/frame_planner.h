#pragma once
// Plans a run's next frame when no script dictates it: its begin, settings, faults, quality level, and the
// simulated time that it shows.
//
// Begin: frame_starter.h decides it. In free-run, frame k begins at s_k = s_0 + k period in the camera's time
// (clock.h; at scale 1 that is CLOCK_MONOTONIC). Its middle, its end and the period follow from exposure,
// frame rate and shutter (shutter_timing.h). Rendering begins at s_k and shows the pose propagated to the
// middle; the frame does not leave before its end. Example, global shutter, 30 Hz, 2 ms: rendering starts at
// 0.0 and shows the pose of 1.0 ms; a frame computed in 25 ms leaves at 25 ms; the next rendering starts at
// 33.3 ms. A start missed by more than a period is skipped and counted, and its frame id stays unused.
//
// Settings: exposure and gain come from the live settings, or from the frame's step of the camera's sequence.
// Automatic exposure sets them from a measurement of the frame that used the same slot last, two frames
// earlier in the loop, so the result does not depend on timing. Faults are those in force when the frame
// begins.
//
// While simulated time stands still, or poses are stale and the world is held (pose_watch.h), a frame shows
// one instant of the world without blur. If the shutter is to be closed then, nothing is rendered.
//
// Quality: with a frame budget, the governor (governor.h) chooses each frame's level from the time that
// earlier frames took: that of the longer stage, or with loop.prefer `latency` of both, because that is how
// long the next frame waits. The governor receives a frame's time when the next frame takes over its slot.
// With frame_budget_ms: auto the budget is the real time until the next exposure is due, by the settings and
// the clock at the frame's begin. A triggered frame then has no budget, because the time of the next trigger
// is unknown. The governor is off in lockstep, where frames must not depend on the machine, and for frames
// that are not paced.

#include <atomic>
#include <cstdint>

#include "emulator/loop/frame_slot.h"
#include "emulator/loop/frame_starter.h"
#include "emulator/loop/governor.h"
#include "emulator/loop/loop_parts.h"
#include "emulator/loop/shutter_timing.h"
#include "io/system/bounded_queue.h"

namespace hilcam {

// A change of level by the governor, from a frame on.
struct LevelChange {
    std::uint64_t frame = 0;
    std::size_t from = 0, to = 0;
    double mean_ms = 0;    // mean time of the frames before it
    double budget_ms = 0;  // 0: frames have no time limit from then on
};

class FramePlanner {
  public:
    explicit FramePlanner(const LoopParts& parts);

    // Waits for the next frame's begin and writes what the frame depends on into the slot, which still holds
    // the results of its last frame. ends_order: true for the last frame of an order. Returns false when
    // `stopping`. Loop, one thread.
    bool next(const std::atomic<bool>& stopping, FrameSlot& slot, bool& ends_order);

    // Takes the oldest change that has not been taken; false when there is none. One thread.
    bool take_level_change(LevelChange& change) noexcept { return level_changes_.pop(change); }
    // Returns how long the planned frame may take [ms]; 0: no limit. Loop.
    double budget_ms() const { return governor_.budget_ms(); }

  private:
    void take_settings(const FrameStarter::Start& start, FrameSlot& slot);
    void place_in_time(const FrameStarter::Start& start, FrameSlot& slot) const;
    double frame_ms(const FrameSlot& slot) const;
    double budget_ms(const FrameStarter::Start& start) const;
    std::uint32_t choose_level(const FrameStarter::Start& start, const FrameSlot& slot, std::uint64_t frame);

    const CameraModel& camera_;
    ShutterTiming timing_;
    FaultBoard& faults_;
    SimulatedClock& clock_;
    const PoseWatch* poses_;
    LoopPreference prefer_;
    FrameStarter starter_;
    bool budget_is_of_rate_;
    Governor governor_;
    BoundedQueue<LevelChange, 64> level_changes_;
    std::uint64_t last_id_ = 0;
};

}  // namespace hilcam
