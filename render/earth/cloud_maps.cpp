#include "render/earth/cloud_maps.h"

#include <algorithm>

#include "render/vocabulary/check.h"

namespace hilcam {

CloudMaps::CloudMaps(EarthMap one) {
    if (!one.empty()) maps_.push_back(std::move(one));
}

CloudMaps::CloudMaps(std::vector<Timed> maps) {
    std::vector<TimeTai> instants;
    for (Timed& timed : maps) {
        HILCAM_CHECK(!timed.map.empty());
        instants.push_back(timed.at), maps_.push_back(std::move(timed.map));
    }
    times_ = MapTimes(instants);
}

int CloudMaps::height() const {
    int height = 0;
    for (const EarthMap& map : maps_) height = std::max(height, map.height());
    return height;
}

std::size_t CloudMaps::bytes() const {
    std::size_t sum = 0;
    for (const EarthMap& map : maps_) sum += map.bytes();
    return sum;
}

template <class Footprint>
EarthSample CloudMaps::mix(double number, float u, float v, const Footprint& footprint) const {
    const auto first = static_cast<std::size_t>(number);
    const auto share = static_cast<float>(number - static_cast<double>(first));
    const EarthSample before = maps_[first].sample(u, v, footprint);
    if (share == 0) return before;
    const EarthSample after = maps_[first + 1].sample(u, v, footprint);
    const float then = (1 - share) * before.cloud(), now = share * after.cloud();
    EarthSample out;
    out.value[EarthSample::kCloud] = then + now;
    // The top belongs to the cloud that there is.
    if (then + now > 0)
        out.value[EarthSample::kCloudTop] =
            (then * before.value[EarthSample::kCloudTop] + now * after.value[EarthSample::kCloudTop]) /
            (then + now);
    return out;
}

EarthSample CloudMaps::sample(double number, float u, float v, const MapFootprint& footprint) const {
    return mix(number, u, v, footprint);
}
EarthSample CloudMaps::sample(double number, float u, float v, float width) const {
    return mix(number, u, v, width);
}

}  // namespace hilcam
