#include "render/sky/air_lift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

AirLift::AirLift(AirGround ground, const Spectrum& returned)
    : ground_(std::move(ground)), lifts_(ground_.albedo.size()) {
    HILCAM_CHECK(ground_.width > 0 && ground_.height > 0 &&
                 ground_.albedo.size() == static_cast<std::size_t>(ground_.width * ground_.height));
    for (std::size_t i = 0; i < lifts_.size(); ++i)
        for (int b = 0; b < kMaxBins; ++b) {
            const float albedo = ground_.albedo[i][b];
            lifts_[i][b] = albedo / (1 - albedo * returned[b]);
        }
}

AirGround AirLift::even(double albedo) {
    AirGround out;
    out.albedo.emplace_back().bin.fill(static_cast<float>(albedo));
    return out;
}

Spectrum AirLift::at(Vec3d point_m) const {
    const double r = length(point_m);
    const double x = (std::atan2(point_m.y, point_m.x) / (2 * kPi) + 0.5) * ground_.width - 0.5,
                 y = (0.5 - std::asin(std::clamp(point_m.z / r, -1.0, 1.0)) / kPi) * ground_.height - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const auto cell = [&](int column, int row) -> const Spectrum& {
        const int i = (column + ground_.width) % ground_.width, j = std::clamp(row, 0, ground_.height - 1);
        return lifts_[static_cast<std::size_t>(j * ground_.width + i)];
    };
    Spectrum out = ((1 - fx) * (1 - fy)) * cell(x0, y0);
    out += (fx * (1 - fy)) * cell(x0 + 1, y0);
    out += ((1 - fx) * fy) * cell(x0, y0 + 1);
    out += (fx * fy) * cell(x0 + 1, y0 + 1);
    return out;
}

std::string AirLift::describe() const {
    return varies() ? "over the Earth's albedo by place"
                    : "over albedo " + std::to_string(ground_.albedo.front()[0]).substr(0, 5);
}

}  // namespace hilcam
