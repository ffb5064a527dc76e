// Lists the parts of the Earth's model (earth_model.h), and makes a copy without one.

#include <string>
#include <vector>

#include "render/earth/earth_model.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::string map_text(const GroundMaps& ground) {
    const int height = ground.height();
    return (ground.count() > 1 ? std::to_string(ground.count()) + " maps by time, the finest"
                               : std::string("map")) +
           " of " + std::to_string(2 * height) + " x " + std::to_string(height) + " with its halves";
}

std::string finer_levels(const EarthDetail* detail) {
    if (!detail) return {};
    return ", finer ones to " + std::to_string(detail->shape().columns) + " x " +
           std::to_string(detail->shape().rows) + " by tiles of " + detail->files();
}

}  // namespace

std::vector<EarthModel::PartInfo> EarthModel::parts() const {
    const auto rounded = [](double value) {
        std::string text = std::to_string(value);
        return text.substr(0, text.find('.') + 2);
    };
    std::vector<PartInfo> out;
    const auto add = [&](Part part, const std::string& text, std::size_t bytes) {
        PartInfo& info = out.emplace_back();
        info.part = part, info.text = text, info.bytes = bytes;
    };
    add(Part::kSurface, map_text(ground()) + finer_levels(detail_.get()),
        ground().bytes() + (detail_ ? detail_bytes_ : 0));
    if (glints_) add(Part::kSea, "sea: Cox-Munk glint at " + rounded(wind_m_s_) + " m/s", 0);
    if (table_)
        add(Part::kClouds,
            "clouds: table by doubling, shadows" + std::string(together() ? "" : ", ") +
                (cloud_maps_->count() > 1 ? std::to_string(cloud_maps_->count()) + " maps by time"
                                          : (together() ? "" : "a map of their own")),
            table_->bytes() + cloud_maps_->bytes());
    if (air_) add(Part::kAir, "air: above the clouds and below them", columns_->bytes());
    if (lights_ > 0) add(Part::kLights, "lights of cities", 0);
    return out;
}

EarthModel EarthModel::without(Part part) const {
    HILCAM_CHECK(part != Part::kSurface);
    EarthModel out = *this;
    if (part == Part::kSea) out.glints_ = false;
    if (part == Part::kClouds) out.table_.reset();
    if (part == Part::kAir) out.air_ = nullptr, out.columns_.reset();
    if (part == Part::kLights) out.lights_ = 0;
    return out;
}

}  // namespace hilcam
