#include "render/earth/ground_maps.h"

#include <algorithm>

#include "render/vocabulary/check.h"

namespace hilcam {

GroundMaps::GroundMaps(EarthMap one) {
    HILCAM_CHECK(!one.empty());
    maps_.push_back(std::move(one));
}

GroundMaps::GroundMaps(std::vector<Timed> maps) {
    std::vector<TimeTai> instants;
    for (Timed& timed : maps) instants.push_back(timed.at), maps_.push_back(std::move(timed.map));
    times_ = MapTimes(instants);
    require_maps();
}

GroundMaps::GroundMaps(std::vector<Monthly> maps) {
    std::vector<int> months;
    for (Monthly& monthly : maps) months.push_back(monthly.month), maps_.push_back(std::move(monthly.map));
    times_ = MapTimes::of_months(months);
    require_maps();
}

void GroundMaps::require_maps() const {
    HILCAM_CHECK(!maps_.empty() &&
                 std::none_of(maps_.begin(), maps_.end(), [](const EarthMap& map) { return map.empty(); }));
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
