#include "render/sky/air_lift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/vocabulary/check.h"

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

Spectrum AirLift::at(float u, float v) const {
    const float x = u * static_cast<float>(ground_.width) - 0.5f,
                y = v * static_cast<float>(ground_.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    const float fx = x - left, fy = y - top;
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
