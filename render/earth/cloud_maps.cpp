#include "render/earth/cloud_maps.h"

#include <algorithm>

#include "render/vocabulary/check.h"

namespace hilcam {

CloudMaps::CloudMaps(EarthMap one) {
    if (!one.empty()) maps_.push_back({{}, std::move(one)});
}

CloudMaps::CloudMaps(std::vector<Timed> maps) : maps_(std::move(maps)) {
    for (std::size_t i = 0; i < maps_.size(); ++i)
        HILCAM_CHECK(!maps_[i].map.empty() && (i == 0 || maps_[i - 1].at < maps_[i].at));
}

int CloudMaps::height() const {
    int height = 0;
    for (const Timed& timed : maps_) height = std::max(height, timed.map.height());
    return height;
}

std::size_t CloudMaps::bytes() const {
    std::size_t sum = 0;
    for (const Timed& timed : maps_) sum += timed.map.bytes();
    return sum;
}

double CloudMaps::number_at(TimeTai time) const {
    const auto after = std::upper_bound(maps_.begin(), maps_.end(), time,
                                        [](TimeTai t, const Timed& m) { return t < m.at; });
    if (after == maps_.begin()) return 0;
    const auto number = static_cast<double>(after - maps_.begin() - 1);
    if (after == maps_.end()) return number;
    const TimeTai before = std::prev(after)->at;
    return number + static_cast<double>(time - before) / static_cast<double>(after->at - before);
}

double CloudMaps::nearest(double number) const {
    return maps_.empty() ? 0 : std::clamp(number, 0.0, static_cast<double>(maps_.size() - 1));
}

template <class Footprint>
EarthSample CloudMaps::mix(double number, float u, float v, const Footprint& footprint) const {
    const auto first = static_cast<std::size_t>(number);
    const auto share = static_cast<float>(number - static_cast<double>(first));
    const EarthSample before = maps_[first].map.sample(u, v, footprint);
    if (share == 0) return before;
    const EarthSample after = maps_[first + 1].map.sample(u, v, footprint);
    const float then = (1 - share) * before.cloud(), now = share * after.cloud();
    EarthSample out;
    out.value[EarthSample::kCloud] = then + now;
    // The top is that of what cloud there is.
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
