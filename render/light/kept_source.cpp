#include "render/light/kept_source.h"

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_microfacet.h"

namespace hilcam {
namespace {

// Directions on an octahedron's faces (Cigolle et al., JCGT 3(2), 2014), at the middle of a cell of a grid.
Vec3f rounded_dir(Vec3f dir, float step_rad) {
    const float sum = std::abs(dir.x) + std::abs(dir.y) + std::abs(dir.z);
    const auto sign = [](float x) { return x >= 0 ? 1.0f : -1.0f; };
    float x = dir.x / sum, y = dir.y / sum;
    if (dir.z < 0) {
        const float folded = (1 - std::abs(y)) * sign(x);
        y = (1 - std::abs(x)) * sign(y);
        x = folded;
    }
    // A face's edge of length 1 spans a right angle.
    const float cells = std::ceil(0.5f * kPiF / step_rad);
    // Shifted, so that the axes, where much points to, are not on the border of two cells.
    const auto middle = [cells](float v) { return (std::floor(v * cells + 0.3f) + 0.2f) / cells; };
    x = std::clamp(middle(x), -1.0f, 1.0f), y = std::clamp(middle(y), -1.0f, 1.0f);
    const float z = 1 - std::abs(x) - std::abs(y);
    return normalized(z >= 0 ? Vec3f{x, y, z}
                             : Vec3f{(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
}

}  // namespace

KeptSource KeptSource::rounded(float step_rad) const {
    KeptSource out = *this;
    if (kind == Kind::kNone || kind == Kind::kGlow) return out;
    out.dir = rounded_dir(dir, step_rad);
    // Steps of a sixty-fourth of the sine: 1 % of the half angle, about.
    const float sine = std::sqrt(std::max(0.0f, 1 - cone_cosine * cone_cosine));
    if (kind == Kind::kCone && cone_cosine > 0) {
        const float kept = std::exp2(std::round(std::log2(std::max(sine, 1e-6f)) * 64) / 64);
        out.cone_cosine = std::sqrt(std::max(0.0f, 1 - kept * kept));
    }
    if (kind == Kind::kLamp) {
        const float grid_m = std::exp2(std::floor(std::log2(std::max(length(position_m), 1e-3f))) - 6);
        const auto middle = [grid_m](float x) { return (std::floor(x / grid_m) + 0.5f) * grid_m; };
        out.position_m = {middle(position_m.x), middle(position_m.y), middle(position_m.z)};
    }
    return out;
}

}  // namespace hilcam
