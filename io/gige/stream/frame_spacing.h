#pragma once
// Spaces late frames so that they do not leave in a burst.
//
// After a stall (the machine had other work), the loop finishes the frames of the missed time one right after
// the other. For a receiver on this machine the sender waits for room in its buffer (receiver_room.h).
// Elsewhere, four frames within some milliseconds overrun the default buffer of a plain client. So a frame
// begins at the earliest half a period after the previous one began. The period is the interval between the
// two exposures: frames on time never wait, and late frames catch up at twice their rate. A replay at full
// speed gives frames before their time; these are not late.
//
// Example at 30 Hz: frames that are ready at 0, 4, 8 and 12 ms begin at 0, 16.7, 33.3 and 50 ms, and the next
// one, ready at 45 ms, at 66.7 ms.

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hilcam {

class FrameSpacing {
  public:
    // Number of frames that may wait behind the next one. When there are more, the oldest is given up: a
    // controller that steers by the pictures wants the newest.
    static constexpr std::size_t kMaxQueued = 1;

    // Returns when a frame may begin; a time up to `now_ns` means at once. Times are CLOCK_MONOTONIC;
    // exposure_mid_ns is mid-exposure. longest_period_ns: the longest period between consecutive frames, 0:
    // unknown; a longer gap between exposures means that frames were skipped.
    std::int64_t earliest_ns(std::int64_t exposure_mid_ns, std::int64_t longest_period_ns,
                             std::int64_t now_ns) const {
        if (begun_ns_ == 0 || exposure_mid_ns > now_ns) return now_ns;
        std::int64_t period_ns = std::max<std::int64_t>(exposure_mid_ns - exposure_mid_ns_, 0);
        if (longest_period_ns > 0) period_ns = std::min(period_ns, longest_period_ns);
        return begun_ns_ + period_ns / 2;
    }
    void begun(std::int64_t exposure_mid_ns, std::int64_t now_ns) {
        exposure_mid_ns_ = exposure_mid_ns;
        begun_ns_ = now_ns;
    }

  private:
    std::int64_t exposure_mid_ns_ = 0, begun_ns_ = 0;  // the last frame sent; 0: none yet
};

}  // namespace hilcam
