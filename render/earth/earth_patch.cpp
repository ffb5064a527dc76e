#include "render/earth/earth_patch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

using Floats = std::array<float, sizeof(EarthAspect) / sizeof(float)>;

HILCAM_CLONES void mix_nodes(const Floats& a, const Floats& b, const Floats& c, const Floats& d,
                             const std::array<float, 4>& w, Floats& sum) {
    for (std::size_t k = 0; k < sum.size(); ++k)
        sum[k] = w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k];
}

}  // namespace

void EarthPatch::place_node(int at, const EarthModel::Ray& ray) {
    const auto i = static_cast<std::size_t>(at);
    EarthAspect aspect;
    // Near the poles longitude turns too fast.
    constexpr float kPole = 0.03f;
    carries_[i] = earth_->aspect_of(ray, aspect) && aspect.v > kPole && aspect.v < 1 - kPole;
    nodes_[i] = std::bit_cast<Node>(aspect);
    halves_[static_cast<std::size_t>(2 * (at / kMostNodes) * kHalves + 2 * (at % kMostNodes))] = {aspect.u,
                                                                                                  aspect.v};
}

void EarthPatch::place_half(int row, int column, const EarthModel::Ray& ray) {
    MapPlace& at = halves_[static_cast<std::size_t>(row * kHalves + column)];
    if (!EarthModel::map_place(ray, at.u, at.v)) at = {};  // no node about it carries
}

bool EarthPatch::add(float x, float y, const Spectrum& weight, Spectrum& radiance) const {
    const float fx = (x - static_cast<float>(box_.x0)) * (1.0f / kPitch_px),
                fy = (y - static_cast<float>(box_.y0)) * (1.0f / kPitch_px);
    const int i = std::clamp(static_cast<int>(fx), 0, kMostNodes - 2),
              j = std::clamp(static_cast<int>(fy), 0, kMostNodes - 2);
    const auto at = static_cast<std::size_t>(j * kMostNodes + i);
    if (!carries_[at] || !carries_[at + 1] || !carries_[at + kMostNodes] || !carries_[at + kMostNodes + 1])
        return false;
    const float s = fx - static_cast<float>(i), t = fy - static_cast<float>(j);
    Node sum;
    mix_nodes(nodes_[at], nodes_[at + 1], nodes_[at + kMostNodes], nodes_[at + kMostNodes + 1],
              {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}, sum);
    EarthAspect aspect = std::bit_cast<EarthAspect>(sum);
    // Lagrange's parabolas, both ways; longitudes as turns from the first.
    const std::array<float, 3> across{(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)},
        down{(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)};
    const MapPlace* const first = halves_.data() + 2 * j * kHalves + 2 * i;
    aspect.u = first->u, aspect.v = 0;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            const MapPlace& here = first[row * kHalves + column];
            const float w = down[row] * across[column], off = here.u - first->u;
            aspect.u += w * (off > 0.5f ? off - 1 : (off < -0.5f ? off + 1 : off));
            aspect.v += w * here.v;
        }
    const EarthModel::Shade seen = earth_->shade(aspect);
    radiance += weight * (irradiance_ * seen.over_sun_sr + seen.lights_w_m2_sr_um);
    return true;
}

}  // namespace hilcam
