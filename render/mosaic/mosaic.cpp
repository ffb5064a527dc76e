#include "render/mosaic/mosaic.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hilcam {
namespace {

// Texels are no longer than this, where there are such: a choice by its error (docs/decisions.md).
constexpr float kSharp_px = 0.35f;

// Whole numbers.
struct WholeNumbers {
    int first, last;

    // Those at which a line through `at` with this step is within half_width of the pixel's middle, of those before.
    void cut(float at, float step, float half_width) {
        const float from = (0.5f - half_width - at) / step, to = (0.5f + half_width - at) / step;
        // Beyond all texels, or no number: nothing is cut.
        if (!(std::abs(from) < 1e6f && std::abs(to) < 1e6f)) {
            if (std::abs(at - 0.5f) > half_width) last = first - 1;
            return;
        }
        first = std::max(first, static_cast<int>(std::ceil(std::min(from, to))));
        last = std::min(last, static_cast<int>(std::floor(std::max(from, to))));
    }
};

}  // namespace

// The way in the pixel from a texel to the next in its row and in its column [px].
struct Mosaic::Steps {
    float x_column, x_row, y_column, y_row;

    // Those of the finest texels. False: the pixel sees the plane from its edge.
    static bool find(const Footprint& pixel, Steps& out) {
        const float turned = pixel.per_x.x * pixel.per_y.y - pixel.per_x.y * pixel.per_y.x, per = 1 / turned;
        if (!(std::abs(turned) > 1e-12f) || !std::isfinite(per)) return false;
        out = {per * pixel.per_y.y, -per * pixel.per_y.x, -per * pixel.per_x.y, per * pixel.per_x.x};
        return true;
    }
    Steps times(float size) const { return {size * x_column, size * x_row, size * y_column, size * y_row}; }
    float x_width() const { return std::abs(x_column) + std::abs(x_row); }
    float y_width() const { return std::abs(y_column) + std::abs(y_row); }
};

// False: there is no room in the window.
bool Mosaic::find_window(const Footprint& pixel, const Steps& finest, std::size_t level,
                         MosaicWindow& out) const {
    const Level& there = levels_[level];
    const auto size = static_cast<float>(std::size_t{1} << level);
    const Steps steps = finest.times(size);
    out.count = 0;
    out.x_step = steps.x_column, out.y_step = steps.y_column;
    out.x_fall = 1 / steps.x_width(), out.y_fall = 1 / steps.y_width();
    const float half_x = 0.5f + 0.5f * steps.x_width(), half_y = 0.5f + 0.5f * steps.y_width();
    // In texels of this level, by their middles.
    const double column = pixel.middle.x / static_cast<double>(size) - 0.5,
                 row = pixel.middle.y / static_cast<double>(size) - 0.5;
    const double reach =
        static_cast<double>((half_x * std::abs(pixel.per_x.y) + half_y * std::abs(pixel.per_y.y)) / size);
    const auto whole = [&](double at) {
        return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(there.rows)));
    };
    const int first = std::max(0, whole(std::ceil(row - reach))),
              last = std::min(there.rows - 1, whole(std::floor(row + reach)));
    for (int r = first; r <= last; ++r) {
        const double below = r - row;
        const auto at = [&](float per_column, float per_row) {
            return static_cast<float>(0.5 - column * static_cast<double>(per_column) +
                                      below * static_cast<double>(per_row));
        };
        const float x = at(steps.x_column, steps.x_row), y = at(steps.y_column, steps.y_row);
        WholeNumbers columns{0, there.columns - 1};
        columns.cut(x, steps.x_column, half_x), columns.cut(y, steps.y_column, half_y);
        constexpr auto kLanes = static_cast<int>(MosaicTexels::kLanes);
        for (int c = columns.first & -kLanes; c <= columns.last; c += kLanes) {
            if (out.count == MosaicWindow::kMost) return false;
            out.texels[out.count] = &there.texels[there.eight(c, r)];
            out.x[out.count] = x + static_cast<float>(c) * steps.x_column;
            out.y[out.count++] = y + static_cast<float>(c) * steps.y_column;
        }
    }
    return true;
}

Mosaic::Look Mosaic::look(const Footprint& pixel, Vec2f way) const {
    Look out;
    Steps steps{};
    if (!Steps::find(pixel, steps)) return out;
    std::size_t level = 0;
    for (float widest = 2 * std::max(steps.x_width(), steps.y_width());
         widest <= kSharp_px && level + 1 < levels_.size(); widest *= 2)
        ++level;
    MosaicWindow window;
    window.across = std::abs(way.x), window.down = std::abs(way.y);
    while (!find_window(pixel, steps, level, window) && level + 1 < levels_.size()) ++level;
    const MosaicSums sums = sums_of(window, layers);
    const float all = std::accumulate(sums.share.begin(), sums.share.end(), 0.0f);
    if (!(all > 0)) return out;
    for (std::size_t k = 0; k < layers; ++k) {
        if (!(sums.share[k] > 0)) continue;
        out.share[k] = sums.share[k] / all;
        out.place[k] = {sums.x[k] / sums.share[k], sums.y[k] / sums.share[k]};
    }
    if (sums.share[0] > 0) out.lit = std::min(1.0f, sums.lit / sums.share[0]);
    const float upon = all - sums.share[0], lean = kMostLean * 255 / 127;
    if (upon > 0) out.lean = {lean * sums.lean[0] / upon, lean * sums.lean[1] / upon};
    return out;
}

bool Mosaic::covers(const std::array<Vec3d, 3>& corners) const {
    const auto is_there = [&](Vec3d at_m) {
        const Vec3d at = at_m - to_double(corner_m);
        const Level& finest = levels_.front();
        const auto texel = [&](double way_m, int count) {
            return std::clamp(static_cast<int>(way_m / static_cast<double>(texel_m)), 0, count - 1);
        };
        const int column = texel(dot(at, to_double(across)), finest.columns);
        const MosaicTexels& there =
            finest.texels[finest.eight(column, texel(dot(at, to_double(down)), finest.rows))];
        return std::any_of(there.share.begin(), there.share.begin() + layers,
                           [&](const MosaicTexels::Bytes& share) {
                               return share[static_cast<std::size_t>(column) % MosaicTexels::kLanes] > 0;
                           });
    };
    const Vec3d middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    // A texel inwards, as those at the border are filled in part.
    const auto inner = [&](Vec3d corner) {
        const double way_m = length(middle - corner), texel = static_cast<double>(texel_m);
        return way_m > texel ? corner + (texel / way_m) * (middle - corner) : middle;
    };
    return std::all_of(corners.begin(), corners.end(),
                       [&](Vec3d corner) { return is_there(inner(corner)); }) &&
           is_there(middle);
}

bool Mosaic::holds(std::uint16_t surface_there, const std::array<Vec3d, 3>& corners) const {
    if (std::find(surface.begin(), surface.begin() + layers, surface_there) == surface.begin() + layers)
        return false;
    const Vec3d facing = cross(corners[1] - corners[0], corners[2] - corners[0]), up = to_double(normal);
    if (std::abs(dot(facing, up)) < std::cos(static_cast<double>(kMostLean)) * length(facing)) return false;
    // What rounding and levels of detail move.
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
