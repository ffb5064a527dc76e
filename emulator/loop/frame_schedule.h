#pragma once
// Says when frames are exposed in free-run: an absolute raster that never drifts and never catches up.
//     next = last + period; when `now` has passed the start after next, whole periods are skipped and
//     counted.
// Times are int64 ns, of any one clock: here the camera's (clock.h).

#include <cstdint>

namespace hilcam {

// The longest that a stop, or a change of the clock, waits for a thread of the loop to look up from its
// sleep.
inline constexpr std::int64_t kLongestSleep_ns = 5'000'000;

class FrameSchedule {
  public:
    explicit FrameSchedule(std::int64_t first_ns) : last_ns_(first_ns) {}

    struct Slot {
        std::int64_t start_ns = 0;
        std::uint64_t skipped = 0;
    };
    // The next exposure, if the period is that.
    std::int64_t next_ns(std::int64_t period_ns) const { return begun_ ? last_ns_ + period_ns : last_ns_; }
    // The exposure to compute now. A start up to one period in the past still counts: that frame is late, not
    // lost.
    Slot take(std::int64_t now_ns, std::int64_t period_ns) {
        Slot slot{next_ns(period_ns), 0};
        if (now_ns > slot.start_ns + period_ns) {
            slot.skipped = static_cast<std::uint64_t>((now_ns - slot.start_ns) / period_ns);
            slot.start_ns += static_cast<std::int64_t>(slot.skipped) * period_ns;
        }
        last_ns_ = slot.start_ns;
        begun_ = true;
        return slot;
    }
    // Begins the raster anew after a pause.
    void restart(std::int64_t first_ns) { last_ns_ = first_ns, begun_ = false; }

  private:
    std::int64_t last_ns_;
    bool begun_ = false;
};

}  // namespace hilcam
