#include "render/earth/ground_maps.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The share of the year that is over, months as twelfths: the calendar's mean year, from 1 January 2000 on, which is within two days of each
// year's own.
double share_of_year(TimeTai time) {
    constexpr double kYear_days = 365.2425, kStart_days = 2451544.5;  // Julian date of 2000-01-01T00:00
    const JulianDate now = julian_tt(time);
    const double years = (now.day - kStart_days + now.fraction) / kYear_days;
    return years - std::floor(years);
}

double seconds_of(TimeTai time) { return static_cast<double>(time.ns) * kSecondsPerNs; }

}  // namespace

GroundMaps::GroundMaps(EarthMap one) {
    HILCAM_CHECK(!one.empty());
    maps_.push_back(std::move(one)), times_.push_back(0);
}

GroundMaps::GroundMaps(std::vector<Timed> maps) {
    HILCAM_CHECK(!maps.empty());
    for (Timed& timed : maps) {
        HILCAM_CHECK(!timed.map.empty() && (times_.empty() || times_.back() < seconds_of(timed.at)));
        maps_.push_back(std::move(timed.map)), times_.push_back(seconds_of(timed.at));
    }
}

GroundMaps::GroundMaps(std::vector<Monthly> maps) : is_yearly_(true) {
    HILCAM_CHECK(!maps.empty());
    for (Monthly& monthly : maps) {
        const double middle = (monthly.month - 0.5) / 12;
        HILCAM_CHECK(!monthly.map.empty() && (times_.empty() || times_.back() < middle));
        maps_.push_back(std::move(monthly.map)), times_.push_back(middle);
    }
}

int GroundMaps::height() const {
    int height = 0;
    for (const EarthMap& map : maps_) height = std::max(height, map.height());
    return height;
}

std::size_t GroundMaps::bytes() const {
    std::size_t sum = 0;
    for (const EarthMap& map : maps_) sum += map.bytes();
    return sum;
}

double GroundMaps::number_at(TimeTai time) const {
    if (maps_.size() == 1) return 0;
    const double now = is_yearly_ ? share_of_year(time) : seconds_of(time);
    const auto after = std::upper_bound(times_.begin(), times_.end(), now) - times_.begin();
    const auto last = static_cast<std::ptrdiff_t>(times_.size()) - 1;
    const auto at = [&](std::ptrdiff_t i) { return times_[static_cast<std::size_t>(i)]; };
    if (after > 0 && after <= last)
        return static_cast<double>(after - 1) + (now - at(after - 1)) / (at(after) - at(after - 1));
    if (!is_yearly_) return after == 0 ? 0 : static_cast<double>(last);
    // Around the turn of the year.
    const double since_last = now - at(last) + (after == 0 ? 1 : 0), between = at(0) + 1 - at(last);
    return static_cast<double>(last) + since_last / between;
}

double GroundMaps::nearest(double number) const {
    const auto count = static_cast<double>(maps_.size());
    if (is_yearly_) return number - count * std::floor(number / count);
    return std::clamp(number, 0.0, count - 1);
}

template <class Footprint>
EarthSample GroundMaps::mix(double number, float u, float v, const Footprint& footprint) const {
    if (maps_.size() == 1) return maps_.front().sample(u, v, footprint);
    const auto floor = static_cast<std::size_t>(number);
    const auto share = static_cast<float>(number - static_cast<double>(floor));
    EarthSample out = maps_[floor % maps_.size()].sample(u, v, footprint);
    if (share == 0) return out;
    const EarthSample after = maps_[(floor + 1) % maps_.size()].sample(u, v, footprint);
    for (std::size_t c = 0; c < out.value.size(); ++c)
        out.value[c] += share * (after.value[c] - out.value[c]);
    return out;
}

EarthSample GroundMaps::sample(double number, float u, float v, const MapFootprint& footprint) const {
    return mix(number, u, v, footprint);
}
EarthSample GroundMaps::sample(double number, float u, float v, float width) const {
    return mix(number, u, v, width);
}

}  // namespace hilcam
