#include "emulator/run/silence_log.h"

#include <spdlog/spdlog.h>

namespace hilcam {
namespace {

constexpr std::int64_t kBetweenSilenceLines_ns = 10'000'000'000;

const char* meaning_of(WhenStale what) {
    switch (what) {
        case WhenStale::kPropagate:
            return "things move on with their last velocities";
        case WhenStale::kHold:
            return "the world stands";
        case WhenStale::kBlack:
            return "the shutter is closed";
        case WhenStale::kStop:
            break;
    }
    return "no frames are taken";
}

const char* meaning_of(WhenBackwards what) {
    switch (what) {
        case WhenBackwards::kFlag:
            return "they count, and frames are flagged";
        case WhenBackwards::kAccept:
            return "they count";
        case WhenBackwards::kRefuse:
            break;
    }
    return "they are refused";
}

}  // namespace

void SilenceLog::look() {
    const TimeTai now = clock_.now();
    const PoseWatch::Silence silence = poses_.at(now);
    if (silence.stale && !stale_)
        spdlog::warn("no pose for {} s, since {}: {} (commands.poses.when_stale)",
                     poses_.rules().stale_after_s, format_utc(silence.since),
                     meaning_of(poses_.rules().when_stale));
    if (!silence.stale && stale_)
        spdlog::info("poses come again, after {:.3f} s",
                     static_cast<double>(now - since_) * kSecondsPerNs + poses_.rules().stale_after_s);
    stale_ = silence.stale;
    if (stale_) since_ = silence.since;
    look_at_tags(monotonic_ns());
}

void SilenceLog::look_at_tags(std::int64_t now_ns) {
    const std::uint64_t went_back = poses_.went_back();
    if (went_back == told_ || now_ns < next_ns_) return;
    spdlog::warn("time tags of {} poses went back by more than {} s: {} (commands.poses.backwards)",
                 went_back - told_, poses_.rules().late_s, meaning_of(poses_.rules().backwards));
    told_ = went_back;
    next_ns_ = now_ns + kBetweenSilenceLines_ns;
}

}  // namespace hilcam
