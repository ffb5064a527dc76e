#include "render/lod/coverage_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hilcam {
namespace {

// Texels are not longer than this if finer ones exist: chosen by the error
// (docs/decisions.md#coverage-maps-of-flat-parts).
constexpr float kSharp_px = 0.35f;
constexpr auto kEight = static_cast<int>(CoverageTexels::kLanes);

// Integers from `first` to before `end`.
struct WholeNumbers {
    int first, end;

    // Returns the integers within reach of the middle, from 0 to before count.
    static WholeNumbers about(double middle, double reach, int count) {
        const auto bound = [&](double at) {
            return at > 0 ? static_cast<int>(std::min(at, static_cast<double>(count))) : 0;
        };
        return {bound(std::ceil(middle - reach)), bound(std::floor(middle + reach) + 1)};
    }
    std::uint32_t count() const { return static_cast<std::uint32_t>(std::max(0, end - first)); }
};

}  // namespace

// Steps of texels in a pixel, in units of a texel's width there: the filter's side falls off over one unit,
// so that neighbouring pixels add up to one.
struct CoverageMap::Steps {
    // From a texel to the next one in its row and in its column [widths].
    float x_column, x_row, y_column, y_row;
    float x_px, y_px;  // width of the finest texels

    // Returns false if the pixel sees the plane edge-on.
    static bool find(const Footprint& pixel, Steps& out) {
        const Vec2f x = pixel.per_x, y = pixel.per_y;
        const float turned = x.x * y.y - x.y * y.x, per = 1 / turned;
        if (!(std::abs(turned) > 1e-12f) || !std::isfinite(per)) return false;
        const float across = std::abs(y.x) + std::abs(y.y), down = std::abs(x.x) + std::abs(x.y);
        const float per_across = std::copysign(1 / across, turned),
                    per_down = std::copysign(1 / down, turned);
        out = {per_across * y.y, -per_across * y.x,      -per_down * x.y,
               per_down * x.x,   std::abs(per) * across, std::abs(per) * down};
        return true;
    }
};

// Returns the part of a level around a pixel.
CoverageWindow CoverageMap::window(const Footprint& pixel, const Steps& steps, std::size_t level) const {
    const Level& there = levels_[level];
    const auto size = static_cast<float>(std::size_t{1} << level);
    CoverageWindow out;
    out.x_column = steps.x_column, out.x_row = steps.x_row;
    out.y_column = steps.y_column, out.y_row = steps.y_row;
    out.x_reach = 0.5f + 0.5f / (size * steps.x_px), out.y_reach = 0.5f + 0.5f / (size * steps.y_px);
    const auto about = [&](double middle, float x_way, float y_way, int count) {
        const float reach =
            out.x_reach * steps.x_px * std::abs(x_way) + out.y_reach * steps.y_px * std::abs(y_way);
        return WholeNumbers::about(middle, static_cast<double>(reach), count);
    };
    // In texels of this level, measured from their middles.
    const auto per_size = 1 / static_cast<double>(size);
    const double column = per_size * pixel.middle.x - 0.5, row = per_size * pixel.middle.y - 0.5;
    const WholeNumbers columns = about(column, pixel.per_x.x, pixel.per_y.x, there.columns),
                       rows = about(row, pixel.per_x.y, pixel.per_y.y, there.rows),
                       eights{columns.first / kEight, (columns.end + kEight - 1) / kEight};
    if (rows.count() == 0 || columns.count() == 0) return out;
    out.row = static_cast<float>(rows.first - row);
    out.column = static_cast<float>(eights.first * kEight - column);
    out.rows = rows.count(), out.across = eights.count();
    out.row_of_eights = there.row_of_eights();
    out.kinds = there.kinds.data();
    out.eights = there.eights.data() + there.eight(eights.first, rows.first);
    return out;
}

CoverageMap::Coverage CoverageMap::coverage(const Footprint& pixel, Vec2f way) const {
    Coverage out;
    Steps steps{};
    if (!Steps::find(pixel, steps)) return out;
    std::size_t level = 0;
    for (float widest = 2 * std::max(steps.x_px, steps.y_px);
         widest <= kSharp_px && level + 1 < levels_.size(); widest *= 2)
        ++level;
    CoverageSums sums;
    for (;; ++level) {
        CoverageWindow there = window(pixel, steps, level);
        there.light_across = std::abs(way.x), there.light_down = std::abs(way.y);
        if (find_sums(there, sums) || level + 1 == levels_.size()) break;
    }
    const float all = std::accumulate(sums.share.begin(), sums.share.end(), 0.0f);
    if (!(all > 0)) return out;
    const auto size = static_cast<float>(std::size_t{1} << level);
    const float per_all = 1 / all;
    for (std::size_t k = 0; k < layers; ++k) {
        if (!(sums.share[k] > 0)) continue;
        const float px = size / sums.share[k];
        out.share[k] = per_all * sums.share[k];
        out.place[k] = {0.5f + px * steps.x_px * sums.x[k], 0.5f + px * steps.y_px * sums.y[k]};
    }
    if (sums.share[0] > 0) out.lit = std::min(1.0f, sums.lit / sums.share[0]);
    const float upon = all - sums.share[0], lean = kMaxLean * 255 / 127;
    if (upon > 0) out.lean = {lean * sums.lean[0] / upon, lean * sums.lean[1] / upon};
    return out;
}

bool CoverageMap::covers(const std::array<Vec3d, 3>& corners) const {
    const auto is_there = [&](Vec3d at_m) {
        const Vec3d at = at_m - to_double(corner_m);
        const Level& finest = levels_.front();
        const auto texel = [&](double way_m, int count) {
            return std::clamp(static_cast<int>(way_m / static_cast<double>(texel_m)), 0, count - 1);
        };
        const int column = texel(dot(at, to_double(across)), finest.columns);
        const int row = texel(dot(at, to_double(down)), finest.rows);
        const CoverageTexels& there = finest.kinds[finest.eights[finest.eight(column / kEight, row)]];
        return std::any_of(there.share.begin(), there.share.begin() + layers,
                           [&](const CoverageTexels::Bytes& share) {
                               return share[static_cast<std::size_t>(column) % CoverageTexels::kLanes] > 0;
                           });
    };
    const Vec3d middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    // One texel inwards, because texels at the border are only partly filled.
    const auto inner = [&](Vec3d corner) {
        const double way_m = length(middle - corner), texel = static_cast<double>(texel_m);
        return way_m > texel ? corner + (texel / way_m) * (middle - corner) : middle;
    };
    return std::all_of(corners.begin(), corners.end(),
                       [&](Vec3d corner) { return is_there(inner(corner)); }) &&
           is_there(middle);
}

bool CoverageMap::holds(std::uint16_t surface_there, const std::array<Vec3d, 3>& corners) const {
    if (std::find(surface.begin(), surface.begin() + layers, surface_there) == surface.begin() + layers)
        return false;
    const Vec3d facing = cross(corners[1] - corners[0], corners[2] - corners[0]), up = to_double(normal);
    if (std::abs(dot(facing, up)) < std::cos(static_cast<double>(kMaxLean)) * length(facing)) return false;
    // The tolerance for rounding and levels of detail.
    const auto loose_m = static_cast<double>(kLoose * texel_m);
    return std::all_of(corners.begin(), corners.end(), [&](Vec3d corner) {
        const Vec3d at = corner - to_double(corner_m);
        const double x = dot(at, to_double(across)), y = dot(at, to_double(down)), z = dot(at, up);
        return z <= loose_m && z >= -static_cast<double>(above_m) - loose_m && x >= -loose_m &&
               y >= -loose_m && x <= static_cast<double>(width_m) + loose_m &&
               y <= static_cast<double>(height_m) + loose_m;
    });
}

}  // namespace hilcam
