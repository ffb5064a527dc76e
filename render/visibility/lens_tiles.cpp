#include "render/visibility/lens_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

constexpr double kSide_px = kVisibilityTile_px;
constexpr double kMaxError_px = 0.05;
constexpr int kGridSteps = 32;  // steps of the grid on which the lens's derivatives are sampled
// A margin for larger curvature between the grid's places.
constexpr double kSafety = 1.3;

// Returns the middle of the picture, padded px.
Vec2d center_of(const ImageGeometry& g) {
    return {g.center_px().x + g.guard_px, g.center_px().y + g.guard_px};
}

Vec2d ideal_of(const ImageGeometry& g, Vec2d screen_px) {
    const Vec3d dir = g.direction_camera(screen_px.x - g.guard_px, screen_px.y - g.guard_px);
    const Vec2d center = center_of(g);
    return {center.x + g.focal_length_px * dir.x, center.y + g.focal_length_px * dir.y};
}

struct TileBox {
    double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
    void grow(Vec2d p) {
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
};

// Returns the box of whole tiles, including parts beyond the picture. A lens maps the border to the border.
TileBox ideal_box(const ImageGeometry& g) {
    const auto whole = [](int size) { return std::ceil(size / kSide_px) * kSide_px; };
    const double width = whole(g.padded_width()), height = whole(g.padded_height());
    TileBox box;
    for (double x = 0; x <= width; x += 4) box.grow(ideal_of(g, {x, 0})), box.grow(ideal_of(g, {x, height}));
    for (double y = 0; y <= height; y += 4) box.grow(ideal_of(g, {0, y})), box.grow(ideal_of(g, {width, y}));
    box.x0 -= 1, box.x1 += 1, box.y0 -= 1, box.y1 += 1;
    return box;
}

// Returns the largest second derivative, over the whole box, of the place on the screen by the ideal one,
// along any line [1/px].
struct LensCurvature {
    double bend_per_px = 0;
    bool folds = false;
};
LensCurvature curvature_in(const ImageGeometry& g, const TileBox& box) {
    const Vec2d center = center_of(g);
    const double f = g.focal_length_px, h = 1e-3;
    const auto screen = [&](double x, double y) { return g.distortion.distorted({x, y}); };
    LensCurvature out;
    for (int j = 0; j <= kGridSteps; ++j)
        for (int i = 0; i <= kGridSteps; ++i) {
            const double x = (box.x0 + (box.x1 - box.x0) * i / kGridSteps - center.x) / f;
            const double y = (box.y0 + (box.y1 - box.y0) * j / kGridSteps - center.y) / f;
            const Vec2d at = screen(x, y), right = screen(x + h, y), left = screen(x - h, y),
                        below = screen(x, y + h), above = screen(x, y - h);
            const double xx = (right.x - left.x) / (2 * h), xy = (below.x - above.x) / (2 * h);
            const double yx = (right.y - left.y) / (2 * h), yy = (below.y - above.y) / (2 * h);
            const double determinant = xx * yy - xy * yx;
            if (!(determinant > 0.05 && xx > 0 && yy > 0)) return {0, true};
            const Vec2d diagonal = screen(x + h, y + h), other = screen(x - h, y - h);
            const auto second = [&](double a, double b, double c) { return (a - 2 * b + c) / (h * h); };
            const double along_x = std::hypot(second(right.x, at.x, left.x), second(right.y, at.y, left.y));
            const double along_y = std::hypot(second(below.x, at.x, above.x), second(below.y, at.y, above.y));
            const double across =
                std::hypot(second(diagonal.x, at.x, other.x), second(diagonal.y, at.y, other.y));
            out.bend_per_px = std::max({out.bend_per_px, along_x / f, along_y / f, across / (2 * f)});
        }
    // The largest along any line is at most the sum of those along the axes plus half the mixed one.
    out.bend_per_px *= 2 * kSafety;
    return out;
}

// A tile of the screen as an affine map, and the lens's largest deviation from it.
struct Fit {
    Vec2d middle, right, down;  // ideal places: the tile's middle, and steps of a pixel to the right and down
    TileBox ideal;              // box of the whole tile
    double error_px = 0;        // largest error on the screen
};
Fit fit(const ImageGeometry& g, int tile_x, int tile_y) {
    constexpr double kHalf = 0.5 * kSide_px;
    std::array<std::array<Vec2d, 3>, 3> at;
    Fit out;
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
            at[j][i] = ideal_of(g, {tile_x * kSide_px + static_cast<double>(i) * kHalf,
                                    tile_y * kSide_px + static_cast<double>(j) * kHalf});
            out.ideal.grow(at[j][i]);
        }
    const auto step = [](Vec2d from, Vec2d to) {
        return Vec2d{(to.x - from.x) / kSide_px, (to.y - from.y) / kSide_px};
    };
    out.right = step(at[1][0], at[1][2]), out.down = step(at[0][1], at[2][1]);
    // Halfway between the middle and the corners' mean, so that the lens's curvature is on both sides.
    const auto halfway = [&](double Vec2d::*c) {
        return 0.5 * (at[1][1].*c + 0.25 * (at[0][0].*c + at[0][2].*c + at[2][0].*c + at[2][2].*c));
    };
    out.middle = {halfway(&Vec2d::x), halfway(&Vec2d::y)};
    double farthest = 0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const Vec2d& exact = at[static_cast<std::size_t>(j + 1)][static_cast<std::size_t>(i + 1)];
            farthest = std::max(
                farthest, std::hypot(out.middle.x + kHalf * (i * out.right.x + j * out.down.x) - exact.x,
                                     out.middle.y + kHalf * (i * out.right.y + j * out.down.y) - exact.y));
        }
    out.error_px =
        farthest / std::min(std::hypot(out.right.x, out.right.y), std::hypot(out.down.x, out.down.y));
    return out;
}

int tiles_in(int size_px) { return (size_px + kVisibilityTile_px - 1) / kVisibilityTile_px; }

// Returns the largest error over every fourth tile and the last ones: lenses vary slowly.
double tile_error_px(const ImageGeometry& g) {
    double max_px = 0;
    const int across = tiles_in(g.padded_width()), down = tiles_in(g.padded_height());
    for (int y = 0; y < down + 3; y += 4)
        for (int x = 0; x < across + 3; x += 4)
            max_px = std::max(max_px, fit(g, std::min(x, across - 1), std::min(y, down - 1)).error_px);
    return kSafety * max_px;
}

}  // namespace

bool LensTiles::takes(const ImageGeometry& geometry) {
    if (geometry.distortion.none()) return true;
    if (geometry.distortion.projection != Projection::kRectilinear) return false;
    if (!geometry.distortion.polynomial.none()) return false;
    const TileBox box = ideal_box(geometry);
    if (!(box.x1 - box.x0 < 1e5 && box.y1 - box.y0 < 1e5)) return false;
    return !curvature_in(geometry, box).folds && tile_error_px(geometry) <= kMaxError_px;
}

LensTiles::LensTiles(const ImageGeometry& geometry)
    : geometry_(geometry),
      straight_(geometry.distortion.none()),
      across_(tiles_in(geometry.padded_width())),
      down_(tiles_in(geometry.padded_height())) {
    const Vec2d center = center_of(geometry);
    const double f = geometry.focal_length_px;
    if (straight_) {
        slopes_ = {-center.x / f, (geometry.padded_width() - center.x) / f, -center.y / f,
                   (geometry.padded_height() - center.y) / f};
        return;
    }
    const TileBox box = ideal_box(geometry);
    slopes_ = {(box.x0 - center.x) / f, (box.x1 - center.x) / f, (box.y0 - center.y) / f,
               (box.y1 - center.y) / f};
    const LensCurvature curvature = curvature_in(geometry, box);
    const auto single = [](double v) { return static_cast<float>(v); };
    const LensDistortion& d = geometry.distortion;
    screen_ = {single(center.x), single(center.y), single(f), single(d.k1), single(d.k2), single(d.k3),
               single(d.p1), single(d.p2), single(box.x0), single(box.x1), single(box.y0), single(box.y1),
               // An edge as long as the diagonal of its box deviates from its chord by an eighth of that
               // squared.
               single(0.25 * curvature.bend_per_px), single(tile_error_px(geometry))};
    const auto tiles = static_cast<std::size_t>(across_ * down_);
    forward_.resize(tiles), inverse_.resize(tiles);
    const double none = std::numeric_limits<double>::infinity();
    column_.assign(static_cast<std::size_t>(across_), {none, -none});
    row_.assign(static_cast<std::size_t>(down_), {none, -none});
    for (int y = 0; y < down_; ++y)
        for (int x = 0; x < across_; ++x) make_tile(x, y);
}

void LensTiles::make_tile(int tile_x, int tile_y) {
    const Fit tile = fit(geometry_, tile_x, tile_y);
    const auto i = static_cast<std::size_t>(tile_y * across_ + tile_x);
    const Inverse& inverse = inverse_[i] = {tile.middle, tile.right, tile.down};
    const double determinant = inverse.right.x * inverse.down.y - inverse.right.y * inverse.down.x;
    const auto single = [](double v) { return static_cast<float>(v); };
    forward_[i] = {single(inverse.middle.x),
                   single(inverse.middle.y),
                   single(inverse.down.y / determinant),
                   single(-inverse.down.x / determinant),
                   single(-inverse.right.y / determinant),
                   single(inverse.right.x / determinant)};
    Vec2d& column = column_[static_cast<std::size_t>(tile_x)];
    Vec2d& row = row_[static_cast<std::size_t>(tile_y)];
    column = {std::min(column.x, tile.ideal.x0), std::max(column.y, tile.ideal.x1)};
    row = {std::min(row.x, tile.ideal.y0), std::max(row.y, tile.ideal.y1)};
}

LensTiles::View LensTiles::view(int x_px, int y_px) const {
    const double f = geometry_.focal_length_px, pixel = 1 / f;
    if (straight_)
        return {{slopes_.left + x_px * pixel, slopes_.top + y_px * pixel, 1}, {pixel, 0, 0}, {0, pixel, 0}};
    const Inverse& tile = inverse_[index(x_px, y_px)];
    const Vec2d center = center_of(geometry_);
    const Vec3d right{tile.right.x / f, tile.right.y / f, 0}, down{tile.down.x / f, tile.down.y / f, 0};
    const Vec3d middle{(tile.middle.x - center.x) / f, (tile.middle.y - center.y) / f, 1};
    return {middle - 0.5 * kSide_px * (right + down), right, down};
}

void LensTiles::tiles_of(double x0, double x1, double y0, double y1, TileRange& range) const {
    if (straight_) {
        const auto tile = [](double px, int tiles) {
            return static_cast<std::int16_t>(std::clamp(px / kVisibilityTile_px, 0.0, tiles - 1.0));
        };
        range.x0 = tile(x0 - 1, across_), range.x1 = tile(x1 + 1, across_);
        range.y0 = tile(y0 - 1, down_), range.y1 = tile(y1 + 1, down_);
        return;
    }
    // Columns and rows are ordered, and overlap.
    const auto first = [](const std::vector<Vec2d>& all, double least) {
        const auto at = std::find_if(all.begin(), all.end(), [&](Vec2d part) { return part.y >= least - 1; });
        return static_cast<std::int16_t>(std::min(at, all.end() - 1) - all.begin());
    };
    const auto last = [](const std::vector<Vec2d>& all, double most) {
        const auto at =
            std::find_if(all.rbegin(), all.rend(), [&](Vec2d part) { return part.x <= most + 1; });
        return static_cast<std::int16_t>(std::min(at, all.rend() - 1).base() - all.begin() - 1);
    };
    range.x0 = first(column_, x0), range.x1 = last(column_, x1);
    range.y0 = first(row_, y0), range.y1 = last(row_, y1);
}

}  // namespace hilcam
