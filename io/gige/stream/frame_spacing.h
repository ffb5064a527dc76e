#pragma once
// Spaces frames that come late, so that they do not leave in a burst.
//
// After a stall (the machine had other work) the loop finishes the frames of the missed time one right after the other.
// A receiver on this machine is waited for by the look of its buffer (receiver_room.h); elsewhere, four frames within some
// milliseconds overrun the default buffer of a plain client. So a frame begins half a period after the one before began,
// at the earliest. The period is that of the two frames' exposures: frames on time never wait, and those that are late
// catch up at twice their rate. A replay that runs as fast as it can gives frames before their time: they are not late.
// Example at 30 Hz: frames that are ready at 0, 4, 8 and 12 ms begin at 0, 16.7, 33.3 and 50 ms, and the next one, ready
// at 45 ms, at 66.7 ms.

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hilcam {

class FrameSpacing {
  public:
    // Frames that may wait behind the one whose turn is next. Of more, the oldest is given up: who steers by the
    // pictures wants the newest.
    static constexpr std::size_t kMaxQueued = 1;

    // Returns when a frame may begin; `now_ns` or earlier: at once. Times are CLOCK_MONOTONIC, `exposure_mid_ns` that of
    // the exposure's middle.
    // `longest_period_ns`: of frames that follow one another, 0 when that is not known; a longer gap between exposures
    // is of frames that were skipped.
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
    std::int64_t exposure_mid_ns_ = 0, begun_ns_ = 0;  // times of the last frame that was sent; 0: none yet
};

}  // namespace hilcam
