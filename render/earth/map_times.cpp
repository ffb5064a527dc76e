#include "render/earth/map_times.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Returns the elapsed fraction of the year, with months as twelfths, in the calendar's mean year from 1
// January 2000 on. That is within two days of each actual year.
double share_of_year(TimeTai time) {
    constexpr double kYear_days = 365.2425, kStart_days = 2451544.5;  // Julian date of 2000-01-01T00:00
    const JulianDate now = julian_tt(time);
    const double years = (now.day - kStart_days + now.fraction) / kYear_days;
    return years - std::floor(years);
}

double seconds_between(TimeTai from, TimeTai to) {
    return static_cast<double>(to.ns - from.ns) * kSecondsPerNs;
}

void require_order(const std::vector<double>& times) {
    HILCAM_CHECK(std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end());
}

}  // namespace

MapTimes::MapTimes(std::span<const TimeTai> instants) {
    if (instants.empty()) return;
    first_ = instants.front();
    for (const TimeTai at : instants) times_.push_back(seconds_between(first_, at));
    require_order(times_);
}

MapTimes MapTimes::of_months(std::span<const int> months) {
    MapTimes out;
    out.is_yearly_ = true;
    for (const int month : months) out.times_.push_back((month - 0.5) / 12);
    require_order(out.times_);
    return out;
}

double MapTimes::number_at(TimeTai time) const {
    if (times_.size() < 2) return 0;
    const double now = is_yearly_ ? share_of_year(time) : seconds_between(first_, time);
    const auto after = std::upper_bound(times_.begin(), times_.end(), now) - times_.begin();
    const auto last = static_cast<std::ptrdiff_t>(times_.size()) - 1;
    const auto at = [&](std::ptrdiff_t i) { return times_[static_cast<std::size_t>(i)]; };
    if (after > 0 && after <= last)
        return static_cast<double>(after - 1) + (now - at(after - 1)) / (at(after) - at(after - 1));
    if (!is_yearly_) return after == 0 ? 0 : static_cast<double>(last);
    // Across the turn of the year.
    const double since_last = now - at(last) + (after == 0 ? 1 : 0), between = at(0) + 1 - at(last);
    return static_cast<double>(last) + since_last / between;
}

double MapTimes::nearest(double number) const {
    if (times_.size() < 2) return 0;
    const auto count = static_cast<double>(times_.size());
    if (is_yearly_) return number - count * std::floor(number / count);
    return std::clamp(number, 0.0, count - 1);
}

}  // namespace hilcam
