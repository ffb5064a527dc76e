#pragma once
// Schedules exposures in free-run on an absolute raster that never drifts and never catches up:
//     next = last + period; when `now` has passed the start after next, whole periods are skipped and
//     counted.
// An exposure that could not begin in time may begin later than the raster says, so that it shows the newest
// pose, if it still ends before the next one begins. The raster itself does not move.
// Times are int64 ns of any one clock; here, of the camera's (clock.h).

#include <algorithm>
#include <cstdint>

namespace hilcam {

// Longest time that a sleeping thread of the loop takes to notice a stop or a change of the clock.
inline constexpr std::int64_t kLongestSleep_ns = 5'000'000;

class FrameSchedule {
  public:
    explicit FrameSchedule(std::int64_t first_ns) : last_ns_(first_ns) {}

    struct Slot {
        std::int64_t start_ns = 0;
        std::uint64_t skipped = 0;
    };
    // Returns the begin of the next exposure for a period.
    std::int64_t next_ns(std::int64_t period_ns) const { return begun_ ? last_ns_ + period_ns : last_ns_; }
    // Returns the exposure to compute now. A start up to one period in the past still counts: that frame is
    // late, not lost. may_move_ns: how much later than the raster a late exposure may begin.
    Slot take(std::int64_t now_ns, std::int64_t period_ns, std::int64_t may_move_ns = 0) {
        Slot slot{next_ns(period_ns), 0};
        if (now_ns > slot.start_ns + period_ns) {
            slot.skipped = static_cast<std::uint64_t>((now_ns - slot.start_ns) / period_ns);
            slot.start_ns += static_cast<std::int64_t>(slot.skipped) * period_ns;
        }
        last_ns_ = slot.start_ns;
        begun_ = true;
        slot.start_ns += std::clamp(now_ns - slot.start_ns, std::int64_t{0}, may_move_ns);
        return slot;
    }
    // Starts a new raster after a pause.
    void restart(std::int64_t first_ns) { last_ns_ = first_ns, begun_ = false; }

  private:
    std::int64_t last_ns_;
    bool begun_ = false;
};

}  // namespace hilcam
