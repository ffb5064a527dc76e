#include "emulator/loop/governor.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

static_assert(Governor::kWindow == 32, "a bit of misses_ each");

Governor::Governor(const GovernorSettings& settings) : on_(settings.on()), measured_(settings.levels) {
    const std::size_t costs = std::min(settings.costs_ms.size(), measured_.size());
    for (std::size_t i = 0; i < costs; ++i) measured_[i].cost_ms = settings.costs_ms[i];
    if (on_ && !settings.is_told()) use_budget(settings.budget_ms);
}

void Governor::use_budget(double budget_ms) {
    if (!on_) return;
    budget_ms_ = budget_ms;
    if (std::abs(budget_ms - chosen_for_ms_) <= kSameBudget * chosen_for_ms_) return;
    chosen_for_ms_ = budget_ms;
    hold_off_ = kMinStay;
    choose();
}

// Chooses the best level that leaves room by what is known; a level of which nothing is known is assumed to
// do so.
void Governor::choose() {
    std::size_t level = 0;
    if (budget_ms_ > 0)
        while (level + 1 < measured_.size() && expected_ms(level) > kRoom * budget_ms_) ++level;
    enter(level, false);
}

std::size_t Governor::take(std::size_t level, double frame_ms) {
    if (!(budget_ms_ > 0) || level != level_) return level_;
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
    constexpr std::int64_t kMeanOf = 16;
    ++frames_;
    misses_ = misses_ << 1 | (frame_ms > budget_ms_ ? 1u : 0u);
    // A plain mean at first, later a running mean over about sixteen frames.
    Measured& here = measured_[level_];
    here.mean_ms += (frame_ms - here.mean_ms) / static_cast<double>(std::min(frames_, kMeanOf));
    if (here.cost_ms > 0 && std::isfinite(here.cost_ms) && frames_ >= kMeanOf)
        load_ = here.mean_ms / here.cost_ms;
    if (climbed_ && frames_ >= kMaxStay) climbed_ = false, hold_off_ = kMinStay;
}

bool Governor::has_room() const { return misses_ == 0 && measured_[level_].mean_ms <= kRoom * budget_ms_; }

std::int64_t Governor::wait() const {
    const Measured& here = measured_[level_];
    const std::int64_t stay =
        here.mean_ms < kFell * here.at_climb_ms ? std::max(kMinStay, hold_off_ / 16) : hold_off_;
    return expected_ms(level_ - 1) > budget_ms_ ? std::max(stay, kDoubtfulStay) : stay;
}

void Governor::enter(std::size_t level, bool by_climbing) {
    level_ = level;
    climbed_ = by_climbing;
    frames_ = 0;
    misses_ = 0;
    // The mean starts again with the first frame, because measure() divides by one then.
}

void Governor::fall() {
    if (level_ + 1 == measured_.size()) return;
    if (climbed_) hold_off_ = std::min(2 * hold_off_, kMaxStay);
    std::size_t next = level_ + 1;
    const auto is_too_slow = [this](std::size_t level) {
        return std::max(measured_[level].mean_ms, expected_ms(level)) > budget_ms_;
    };
    while (next + 1 < measured_.size() && is_too_slow(next)) ++next;
    enter(next, false);
}

}  // namespace hilcam
