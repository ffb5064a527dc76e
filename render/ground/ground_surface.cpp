#include "render/ground/ground_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// A map of a whole turn has only levels in which its first and last posts are still neighbours.
int levels_of(const GroundRaster::Shape& shape) {
    int levels = 1;
    while (std::min(shape.columns >> levels, shape.rows >> levels) >= 4) {
        if (shape.whole_turn && shape.columns % (1 << levels) != 0) break;
        ++levels;
    }
    return levels;
}

// Returns the weights of four neighbours for a point `t` beyond the second.
std::array<double, 4> shares(GroundBetween between, double t) {
    if (between == GroundBetween::kBilinear) return {0, 1 - t, t, 0};
    const double t2 = t * t, t3 = t2 * t;
    return {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t),
            0.5 * (t3 - t2)};
}

}  // namespace

GroundSurface::GroundSurface(const Figure& figure, std::vector<GroundMap> maps, std::size_t max_bytes)
    : figure_(figure), pages_(max_bytes) {
    std::uint32_t key = 0;
    for (GroundMap& map : maps) {
        std::vector<Layer>& layers = layers_[static_cast<std::size_t>(map.kind)];
        const int levels = levels_of(map.raster->shape());
        layers.push_back({std::move(map), key++, levels});
    }
    for (std::vector<Layer>& layers : layers_)
        std::stable_sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
            return a.map.raster->shape().spacing_m < b.map.raster->shape().spacing_m;
        });
}

Vec3d GroundSurface::point(Vec3d n, double height_m) const {
    const double a2 = figure_.equatorial_radius_m * figure_.equatorial_radius_m,
                 b2 = figure_.polar_radius_m * figure_.polar_radius_m;
    const double scale = 1 / std::sqrt(a2 * (n.x * n.x + n.y * n.y) + b2 * n.z * n.z);
    return {(a2 * scale + height_m) * n.x, (a2 * scale + height_m) * n.y, (b2 * scale + height_m) * n.z};
}

// Returns the mean of a row beside a pole, over up to kMax of its posts.
bool GroundSurface::pole_mean(Layer& layer, int level, int row, Vec3d& mean) {
    const auto key = std::pair{level, row};
    if (const auto found = layer.pole_means.find(key); found != layer.pole_means.end()) {
        mean = found->second;
        return is_finite(mean);
    }
    constexpr int kMax = 256;
    const int columns = layer.map.raster->shape().columns >> level, count = std::min(columns, kMax);
    mean = {};
    for (int i = 0; i < count; ++i) {
        Vec3d value;
        value_at(layer, level, static_cast<int>(std::int64_t{i} * columns / count), row, value);
        mean = mean + value / count;
    }
    layer.pole_means[key] = mean;
    return is_finite(mean);
}

// Returns the value of a post, which may be a few posts outside: around the body, that of the edge; behind a
// pole, the mean of the row beside it, so that the pole has one value from all meridians.
bool GroundSurface::value_at(Layer& layer, int level, int column, int row, Vec3d& value) {
    GroundRaster& raster = *layer.map.raster;
    const GroundRaster::Shape& shape = raster.shape();
    const int columns = shape.columns >> level, rows = shape.rows >> level;
    if (shape.whole_turn) {
        column = ((column % columns) + columns) % columns;
        const bool above = row < 0 && shape.pole_above_first_row,
                   below = row >= rows && shape.pole_below_last_row;
        if (above || below) {
            Vec3d mean, before;
            if (!pole_mean(layer, level, above ? 0 : rows - 1, mean)) return false;
            if (!value_at(layer, level, column, above ? -1 - row : 2 * rows - 1 - row, before)) return false;
            value = 2.0 * mean - before;
            return true;
        }
    }
    const float* const at = pages_.post(raster, layer.key, level, std::clamp(column, 0, columns - 1),
                                        std::clamp(row, 0, rows - 1));
    value.x = static_cast<double>(at[0]);
    value.y = static_cast<double>(at[shape.channels > 1 ? 1 : 0]);
    value.z = static_cast<double>(at[shape.channels > 2 ? 2 : 0]);
    return is_finite(value);
}

GroundSurface::Sample GroundSurface::sample(Layer& layer, Vec2d post, int level) {
    const GroundRaster::Shape& shape = layer.map.raster->shape();
    // Beyond the middle of the outermost posts there is only a pole.
    const double left = shape.whole_turn ? -0.5 : 0, top = shape.pole_above_first_row ? -0.5 : 0,
                 bottom = shape.rows - 1 + (shape.pole_below_last_row ? 0.5 : 0);
    // The negation also catches NaN; half a millionth of a post is rounding.
    constexpr double kRounding = 5e-7;
    if (!(post.x >= left - kRounding && post.x <= shape.columns - 1 - left + kRounding &&
          post.y >= top - kRounding && post.y <= bottom + kRounding))
        return {};
    Sample out;
    out.weight = 1;
    if (layer.map.blend_m > 0) {
        double margin = 1e300;
        if (!shape.whole_turn) margin = std::min({margin, post.x, shape.columns - 1 - post.x});
        if (!shape.pole_above_first_row) margin = std::min(margin, post.y);
        if (!shape.pole_below_last_row) margin = std::min(margin, shape.rows - 1 - post.y);
        const double share = std::clamp(margin * shape.spacing_m / layer.map.blend_m, 0.0, 1.0);
        out.weight = share * share * (3 - 2 * share);
    }
    const double width = std::ldexp(1, level);
    const double x = (post.x + 0.5) / width - 0.5, y = (post.y + 0.5) / width - 0.5;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const auto across = shares(layer.map.between, x - column), down = shares(layer.map.between, y - row);
    Posts& posts = layer.posts;
    if (posts.level != level || posts.column != column || posts.row != row) posts = {level, column, row};
    for (std::size_t k = 0; k < 16; ++k) {
        const double share = across[k % 4] * down[k / 4];
        if (share == 0) continue;
        if (!posts.known[k]) {
            const int i = static_cast<int>(k % 4), j = static_cast<int>(k / 4);
            posts.there[k] = value_at(layer, level, column + i - 1, row + j - 1, posts.values[k]);
            posts.known[k] = true;
        }
        if (!posts.there[k]) return {};
        // A map of one channel uses the same value for all.
        if (shape.channels == 1)
            out.value.x += share * posts.values[k].x;
        else
            out.value = out.value + share * posts.values[k];
    }
    if (shape.channels == 1) out.value.y = out.value.z = out.value.x;
    return out;
}

// Calls add(index, share, value) for each place and each layer of a kind from the finest on; add returns the
// remaining weight.
template <class Add>
void GroundSurface::visit(GroundKind kind, std::span<const Vec3d> places, double footprint_m,
                          const Add& add) {
    std::vector<double> left(places.size(), 1.0);
    posts_.resize(places.size());
    for (Layer& layer : layers_[static_cast<std::size_t>(kind)]) {
        if (std::none_of(left.begin(), left.end(), [](double share) { return share > 0; })) return;
        layer.map.raster->find_posts(places, posts_);
        const double across = footprint_m / layer.map.raster->shape().spacing_m;
        const int level =
            across > 1 ? std::min(layer.levels - 1, static_cast<int>(std::log2(across) + 1e-9)) : 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!(left[i] > 0)) continue;
            const Sample found = sample(layer, posts_[i], level);
            if (found.weight > 0) add(i, left[i] * found.weight, found.value);
            left[i] *= 1 - found.weight;
        }
    }
}

void GroundSurface::find_heights(std::span<const Vec3d> places, double footprint_m,
                                 std::span<double> heights_m) {
    std::fill(heights_m.begin(), heights_m.end(), 0.0);
    visit(GroundKind::kHeights, places, footprint_m,
          [&](std::size_t i, double share, Vec3d value) { heights_m[i] += share * value.x; });
}

void GroundSurface::find_colors(std::span<const Vec3d> places, double footprint_m, std::span<Vec3f> colors) {
    std::fill(colors.begin(), colors.end(), Vec3f{1, 1, 1});
    visit(GroundKind::kAlbedo, places, footprint_m, [&](std::size_t i, double share, Vec3d value) {
        colors[i] = colors[i] + to_float(share * (value - Vec3d{1, 1, 1}));
    });
}

void GroundSurface::find_figures(GroundKind kind, std::span<const Vec3d> places, double footprint_m,
                                 std::span<double> figures) {
    const std::vector<double> own(figures.begin(), figures.end());
    const ParameterLimits limits = limits_of(kind).value_or(ParameterLimits{-1e300, 1e300});
    visit(kind, places, footprint_m, [&](std::size_t i, double share, Vec3d value) {
        figures[i] += share * (std::clamp(value.x, limits.least, limits.most) - own[i]);
    });
}

bool GroundSurface::has_hapke() const {
    return std::any_of(layers_.begin() + static_cast<int>(GroundKind::kLobeWidth), layers_.end(),
                       [](const std::vector<Layer>& layers) { return !layers.empty(); });
}

void GroundSurface::find_hapke(std::span<const Vec3d> places, double footprint_m,
                               std::span<HapkeParameters> hapke) {
    std::vector<double> figures(places.size());
    const auto find = [&](GroundKind kind, float HapkeParameters::*of) {
        if (!has(kind)) return;
        for (std::size_t i = 0; i < places.size(); ++i) figures[i] = static_cast<double>(hapke[i].*of);
        find_figures(kind, places, footprint_m, figures);
        for (std::size_t i = 0; i < places.size(); ++i) hapke[i].*of = static_cast<float>(figures[i]);
    };
    find(GroundKind::kLobeWidth, &HapkeParameters::b);
    find(GroundKind::kLobeBackward, &HapkeParameters::c);
    find(GroundKind::kSurgeAmplitude, &HapkeParameters::surge_amplitude);
    find(GroundKind::kSurgeWidth, &HapkeParameters::surge_width);
    if (!has(GroundKind::kSlope)) return;
    for (HapkeParameters& p : hapke)
        p.roughness_tangent =
            static_cast<float>(std::atan(static_cast<double>(p.roughness_tangent)) / kDegree_rad);
    find(GroundKind::kSlope, &HapkeParameters::roughness_tangent);
    for (HapkeParameters& p : hapke)
        p.roughness_tangent =
            static_cast<float>(std::tan(static_cast<double>(p.roughness_tangent) * kDegree_rad));
}

}  // namespace hilcam
