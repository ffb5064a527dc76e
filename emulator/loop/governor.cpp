#include "emulator/loop/governor.h"

#include <algorithm>

namespace hilcam {

static_assert(Governor::kWindow == 32, "a bit of misses_ each");

std::size_t Governor::take(std::size_t level, double frame_ms) {
    if (!settings_.on() || level != level_) return level_;
    if (warm_up_ > 0) {
        --warm_up_;
        return level_;
    }
    measure(frame_ms);
    if (std::popcount(misses_) > kMaxMisses)
        fall();
    else if (level_ > 0 && frames_ >= wait() && has_room()) {
        measured_[level_].at_climb_ms = measured_[level_].mean_ms;
        enter(level_ - 1, true);
    }
    return level_;
}

void Governor::measure(double frame_ms) {
    ++frames_;
    misses_ = misses_ << 1 | (frame_ms > settings_.budget_ms ? 1u : 0u);
    // A plain mean at first, later of about the last sixteen.
    double& mean_ms = measured_[level_].mean_ms;
    mean_ms += (frame_ms - mean_ms) / static_cast<double>(std::min<std::int64_t>(frames_, 16));
    if (climbed_ && frames_ >= kMaxStay) climbed_ = false, hold_off_ = kMinStay;
}

bool Governor::has_room() const {
    return misses_ == 0 && measured_[level_].mean_ms <= kRoom * settings_.budget_ms;
}

std::int64_t Governor::wait() const {
    const Measured& here = measured_[level_];
    return here.mean_ms < kFell * here.at_climb_ms ? std::max(kMinStay, hold_off_ / 16) : hold_off_;
}

void Governor::enter(std::size_t level, bool by_climbing) {
    level_ = level;
    climbed_ = by_climbing;
    frames_ = 0;
    misses_ = 0;
    // The mean begins anew with the first frame: measure() divides by one then.
}

void Governor::fall() {
    if (level_ + 1 == measured_.size()) return;
    if (climbed_) hold_off_ = std::min(2 * hold_off_, kMaxStay);
    std::size_t next = level_ + 1;
    while (next + 1 < measured_.size() && measured_[next].mean_ms > settings_.budget_ms) ++next;
    enter(next, false);
}

}  // namespace hilcam
