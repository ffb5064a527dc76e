#pragma once
// The plan of a run's next frame, where no script has one: when it begins, its settings, faults and
// level of quality, and what it shows of the world's time.
//
// When frames begin is frame_starter.h's business. Timing in free-run: frame k begins at s_k = s_0 + k period
// in the camera's time (clock.h: at scale 1 that of CLOCK_MONOTONIC); its middle, its end and the period
// follow from exposure, frame rate and shutter (shutter_timing.h). Rendering begins at s_k and shows the pose
// of the middle, propagated; the frame leaves not before its end. Example of a global shutter at 30 Hz and 2
// ms: rendering starts at 0.0, the pose is that of 1.0 ms, a frame computed in 25 ms leaves at 25 ms, the
// next rendering starts at 33.3 ms. A start missed by more than a period is skipped and counted; frame ids
// leave a gap there.
//
// Settings of a frame: exposure and gain are those of the live settings, or of its step of the camera's
// sequence, or with automatic exposure what the frame two before it in the loop asks for: that is the one
// whose slot it takes over, so it does not depend on timing. Faults of a frame are those that are in force
// when it begins.
//
// While simulated time stands, or poses are stale and the world is to be held (pose_watch.h), a frame shows
// the world at one instant, without blur; where the shutter is to be closed then, nothing is rendered.
//
// Quality: with a frame budget the governor (governor.h) chooses each frame's level by what earlier frames
// took: the longer of the two stages, or with loop.prefer `latency` both, as that is how long the next frame
// has to wait. The governor gets a frame's time when the next frame takes over its slot. With frame_budget_ms: auto the
// budget is the real time until the next exposure is due, by the settings and the clock at the frame's begin. A
// triggered frame has no budget, as the next trigger's time is unknown. Off in lockstep, where frames must not depend on the machine, and
// where frames are not paced.

#include <atomic>
#include <cstdint>

#include "emulator/loop/frame_slot.h"
#include "emulator/loop/frame_starter.h"
#include "emulator/loop/governor.h"
#include "emulator/loop/loop_parts.h"
#include "emulator/loop/shutter_timing.h"
#include "io/system/bounded_queue.h"

namespace hilcam {

// The governor's decision, from a frame on.
struct LevelChange {
    std::uint64_t frame = 0;
    std::size_t from = 0, to = 0;
    double mean_ms = 0;    // mean over the frames before it
    double budget_ms = 0;  // 0: frames may take as long as they like from there on
};

class FramePlanner {
  public:
    explicit FramePlanner(const LoopParts& parts);

    // Waits for the next frame's begin and says what it depends on, going by what the slot's last frame has
    // left there. ends_order: it is the last frame of an order. False when `stopping`. Loop, one thread.
    bool next(const std::atomic<bool>& stopping, FrameSlot& slot, bool& ends_order);

    // False: there is none that was not taken yet. One thread.
    bool take_level_change(LevelChange& change) noexcept { return level_changes_.pop(change); }
    // Returns how long the planned frame may take [ms]; 0: as long as it likes. Loop.
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
