#include "render/earth/earth_patch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Floats = std::array<float, sizeof(EarthAspect) / sizeof(float)>;

HILCAM_CLONES void mix_nodes(const Floats& a, const Floats& b, const Floats& c, const Floats& d,
                             const std::array<float, 4>& w, Floats& sum) {
    for (std::size_t k = 0; k < sum.size(); ++k)
        sum[k] = w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k];
}

// The light of an aspect relative to white paint in the Sun: the air in front and the illumination, low and
// high.
using Light = std::array<Spectrum, 4>;
Light light_of(const EarthAspect& a) {
    constexpr auto kPerPaint = static_cast<float>(kPi);
    return {kPerPaint * a.air_low, kPerPaint * a.air_high, a.sun_low + a.sky_low, a.sun_high + a.sky_high};
}

}  // namespace

void EarthPatch::place_node(int at, const EarthModel::Ray& ray) {
    const auto i = static_cast<std::size_t>(at);
    EarthAspect aspect;
    // Near the poles longitude changes too fast.
    constexpr float kPole = 0.03f;
    carries_[i] = earth_->aspect_of(ray, aspect) && aspect.v > kPole && aspect.v < 1 - kPole;
    nodes_[i] = std::bit_cast<Node>(aspect);
    halves_[static_cast<std::size_t>(2 * (at / kMaxNodes) * kHalves + 2 * (at % kMaxNodes))] = {aspect.u,
                                                                                                aspect.v};
}

void EarthPatch::place_half(int row, int column, const EarthModel::Ray& ray) {
    MapPlace& at = halves_[static_cast<std::size_t>(row * kHalves + column)];
    if (!earth_->map_place(ray, at.u, at.v)) at = {};  // no node around it can be used
}

void EarthPatch::choose_steps() {
    looked_.fill(false);
    for (int j = 0; j + 1 < down_; ++j)
        for (int i = 0; i + 1 < across_; ++i) {
            float texels = 0;
            bool carries = true;
            for (const int k : {0, 1, kMaxNodes, kMaxNodes + 1}) {
                const auto at = static_cast<std::size_t>(j * kMaxNodes + i + k);
                carries = carries && carries_[at];
                if (carries)
                    texels = std::max(
                        texels,
                        earth_->texels_across(std::bit_cast<EarthAspect>(nodes_[at]).footprint, moment_)
                            .longer);
            }
            // Half a texel from lookup to lookup resolves the bends between texels.
            step_px_[static_cast<std::size_t>(j * kMaxNodes + i)] =
                !carries ? 0 : (texels < 0.125f ? 4 : (texels < 0.25f ? 2 : 1));
        }
}

EarthPatch::Node EarthPatch::between_nodes(Cell cell, float s, float t) const {
    const std::size_t at = cell.index();
    Node sum;
    mix_nodes(nodes_[at], nodes_[at + 1], nodes_[at + kMaxNodes], nodes_[at + kMaxNodes + 1],
              {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}, sum);
    return sum;
}

// At the terminator light falls by powers of ten in a few degrees, and near the limb the air increases fast.
// A cell cannot be used if interpolation between its nodes differs from its middle. ray: through the middle.
void EarthPatch::check_middle(Cell cell, const EarthModel::Ray& ray) {
    // The tolerance in the middle: a share of its light, or of that of white paint in the Sun. A millionth of
    // the latter is below the noise of cameras that see cities.
    constexpr float kShare = 0.01f, kMin = 1e-6f;
    EarthAspect there;
    const bool met = earth_->aspect_of(ray, there);
    const Light light = light_of(there),
                between = light_of(std::bit_cast<EarthAspect>(between_nodes(cell, 0.5f, 0.5f)));
    bool carries = met;
    for (std::size_t i = 0; i < light.size(); ++i)
        for (int b = 0; b < kMaxBins; ++b)
            carries = carries && std::abs(between[i][b] - light[i][b]) <= kShare * light[i][b] + kMin;
    if (!carries) step_px_[cell.index()] = 0;
}

// True if light between the cell's nodes may not be linear. For exponentially falling light the mean of two
// ends is cosh(d / 2) times the value half-way, where d is the logarithm of their ratio: 0.2 % too much at a
// ratio of 1.15. The limb of the standard atmosphere falls faster: with a ratio of 1.3, pixels were 8 % too
// bright there, which the middle does not show.
bool EarthPatch::may_bend(Cell cell) const {
    constexpr float kMax = 1.15f;
    if (step_px_[cell.index()] == 0) return false;
    std::array<Light, 4> corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
        corners[k] = light_of(std::bit_cast<EarthAspect>(nodes_[cell.index() + k % 2 + k / 2 * kMaxNodes]));
    for (std::size_t i = 0; i < corners[0].size(); ++i) {
        const auto [least, most] = std::minmax({max_component(corners[0][i]), max_component(corners[1][i]),
                                                max_component(corners[2][i]), max_component(corners[3][i])});
        if (most > kMax * least) return true;
    }
    return false;
}

Spectrum EarthPatch::look(Cell cell, float s, float t) const {
    EarthAspect aspect = std::bit_cast<EarthAspect>(between_nodes(cell, s, t));
    // Lagrange parabolas in both directions; longitudes as turns from the first.
    const std::array<float, 3> across{(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)},
        along{(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)};
    const MapPlace* const first = halves_.data() + 2 * cell.row * kHalves + 2 * cell.column;
    aspect.u = first->u, aspect.v = 0;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column) {
            const MapPlace& here = first[row * kHalves + column];
            const float w = along[row] * across[column], off = here.u - first->u;
            aspect.u += w * (off > 0.5f ? off - 1 : (off < -0.5f ? off + 1 : off));
            aspect.v += w * here.v;
        }
    const EarthModel::Shade seen = earth_->shade_by_parts(aspect, moment_, EarthModel::kLooksOfPixel);
    return irradiance_ * seen.over_sun_sr + seen.lights_w_m2_sr_um;
}

// Computed by the cell that asks first: on a shared edge either cell gives the same, up to rounding.
const Spectrum& EarthPatch::look_at_corner(Cell cell, int column, int row) {
    const auto at = static_cast<std::size_t>(row * kLooks + column);
    if (!looked_[at]) {
        const auto per_cell = static_cast<float>(pitch_px_ / 2);
        looks_[at] = look(cell, static_cast<float>(column) / per_cell - static_cast<float>(cell.column),
                          static_cast<float>(row) / per_cell - static_cast<float>(cell.row));
        looked_[at] = true;
    }
    return looks_[at];
}

bool EarthPatch::add(float x, float y, const Spectrum& weight, Spectrum& radiance) {
    const float in_x = x - static_cast<float>(box_.x0), in_y = y - static_cast<float>(box_.y0);
    const Cell cell{std::clamp(static_cast<int>(in_x) / pitch_px_, 0, across_ - 2),
                    std::clamp(static_cast<int>(in_y) / pitch_px_, 0, down_ - 2)};
    const int step_px = step_px_[cell.index()];
    if (step_px == 0) return false;
    if (step_px == 1) {
        radiance +=
            weight * look(cell, in_x / static_cast<float>(pitch_px_) - static_cast<float>(cell.column),
                          in_y / static_cast<float>(pitch_px_) - static_cast<float>(cell.row));
        return true;
    }
    const int column = static_cast<int>(in_x) / step_px, row = static_cast<int>(in_y) / step_px,
              n = step_px / 2;
    const float s = in_x / static_cast<float>(step_px) - static_cast<float>(column),
                t = in_y / static_cast<float>(step_px) - static_cast<float>(row);
    Spectrum seen = ((1 - s) * (1 - t)) * look_at_corner(cell, n * column, n * row);
    seen += (s * (1 - t)) * look_at_corner(cell, n * (column + 1), n * row);
    seen += ((1 - s) * t) * look_at_corner(cell, n * column, n * (row + 1));
    seen += (s * t) * look_at_corner(cell, n * (column + 1), n * (row + 1));
    radiance += weight * seen;
    return true;
}

}  // namespace hilcam
