#include "emulator/world/lamp_switches.h"

#include <algorithm>

namespace hilcam {

void LampSwitches::insert(const LampSwitch& order) {
    auto* const begin = switches_.data();
    auto* const end = begin + count_;
    auto* at = std::lower_bound(begin, end, order,
                                [](const LampSwitch& a, const LampSwitch& b) { return a.time < b.time; });
    if (at != end && at->time == order.time) {
        at->level = order.level;
    } else if (count_ < kLength) {
        std::move_backward(at, end, end + 1);
        *at = order;
        ++count_;
    } else if (at != begin) {
        // Drops the oldest.
        before_ = begin->level;
        std::move(begin + 1, at, begin);
        *(at - 1) = order;
    }
}

void LampSwitches::begin_anew() {
    if (count_ > 0) before_ = switches_[count_ - 1].level;
    count_ = 0;
}

double LampSwitches::at(TimeTai time) const {
    const auto* const begin = switches_.data();
    const auto* const after = std::upper_bound(begin, begin + count_, time,
                                               [](TimeTai t, const LampSwitch& s) { return t < s.time; });
    return after == begin ? before_ : (after - 1)->level;
}

double LampSwitches::mean(TimeTai from, TimeTai until) const {
    if (!(from < until)) return at(from);
    double sum_ns = 0, level = at(from);
    TimeTai since = from;
    for (std::size_t i = 0; i < count_; ++i) {
        const LampSwitch& s = switches_[i];
        if (!(from < s.time)) continue;
        if (!(s.time < until)) break;
        sum_ns += level * static_cast<double>(s.time - since);
        since = s.time, level = s.level;
    }
    // Avoids rounding: without a switch, the mean is exactly the level.
    if (since == from) return level;
    return (sum_ns + level * static_cast<double>(until - since)) / static_cast<double>(until - from);
}

}  // namespace hilcam
