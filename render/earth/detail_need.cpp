#include "render/earth/detail_need.h"

#include <algorithm>
#include <cmath>

#include "render/earth/earth_figure.h"
#include "render/earth/map_looks.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kEquatorialRadius_m = kEarthFigure.equatorial_radius_m;
constexpr double kCloudLevel_m = 4000;  // the same as EarthModel's

double angle_rad(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

// A tile as a cap on the stretched sphere.
struct Cap {
    Vec3d middle;  // unit
    double radius_rad;
    double cosine;  // cosine of its latitude nearest to the equator
};

Cap cap_of(const EarthDetail::Shape& shape, const DetailKey& key) {
    constexpr int kTile = EarthDetail::kTile;
    const double per_column = 2 * kPi / shape.columns_at(key.level), per_row = kPi / shape.rows_at(key.level);
    const double west = key.column * kTile * per_column - kPi, north = kPi / 2 - key.row * kTile * per_row;
    // Texels between two tiles belong to both.
    const double across = (kTile + 1) * per_column, down = (kTile + 1) * per_row;
    const double latitude = north - down / 2, longitude = west + across / 2;
    // Projects geodetic latitudes to the sphere.
    const double reduced = std::atan2(kEarthFigure.polar_radius_m * std::sin(latitude),
                                      kEarthFigure.equatorial_radius_m * std::cos(latitude));
    // A long footprint's lookups are up to four of their widths beside its place, and a level serves lookups
    // for up to two of its texels.
    constexpr double kBeside = 4 * 2 / static_cast<double>(kTexelOfLook);
    const double nearest_to_equator = std::abs(latitude) - down / 2 - kBeside * per_row;
    const double cosine = std::max(1e-6, std::cos(std::max(0.0, nearest_to_equator)));
    const double half_across = 0.5 * across * cosine;
    return {
        {std::cos(reduced) * std::cos(longitude), std::cos(reduced) * std::sin(longitude), std::sin(reduced)},
        1.02 * std::hypot(half_across, 0.5 * down),
        cosine};
}

}  // namespace

// The stretched view.
struct DetailNeed::Sight {
    Vec3d camera_m, up, boresight, sun_dir;
    double distance_m, half_field_rad, pixel_rad, horizon_rad, coarser_by;

    explicit Sight(const DetailView& view)
        : camera_m(stretched(kEarthFigure, view.camera_m)),
          up(normalized(camera_m)),
          boresight(normalized(stretched(kEarthFigure, view.boresight))),
          sun_dir(normalized(stretched(kEarthFigure, view.sun_dir))),
          distance_m(std::max(length(camera_m), 1.0001 * kEquatorialRadius_m)),
          // Stretching turns directions by at most a sixth of a degree; one more pixel on each side.
          half_field_rad(view.half_field_rad + 0.003 + view.pixel_rad),
          pixel_rad(view.pixel_rad),
          // Clouds extend beyond the ground's horizon.
          horizon_rad(angle_rad(kEquatorialRadius_m / distance_m) +
                      angle_rad(kEquatorialRadius_m / (kEquatorialRadius_m + kCloudLevel_m))),
          coarser_by(0) {}

    // True when the ground, or a cloud that casts a shadow on it, may be in the field.
    bool may_see(const Cap& cap) const {
        const double mu0 = dot(cap.middle, sun_dir) + cap.radius_rad;
        const double shadow_m = mu0 > 0 ? kCloudLevel_m / std::max(0.05, mu0) : kCloudLevel_m;
        const Vec3d to_middle = kEquatorialRadius_m * cap.middle - camera_m;
        const double far_m = length(to_middle),
                     reach_m =
                         2 * kEquatorialRadius_m * std::sin(std::min(kPi, cap.radius_rad) / 2) + shadow_m;
        if (far_m <= reach_m) return true;
        return angle_rad(dot(to_middle, boresight) / far_m) <= half_field_rad + std::asin(reach_m / far_m);
    }

    // Returns the finest level of a lookup anywhere on the cap, in EarthMap's counting; the level of texel_m
    // is 0.
    double finest_level(const Cap& cap, double from_below_rad, double texel_m) const {
        const double nearest_rad = std::max(0.0, from_below_rad - cap.radius_rad);
        const double d_m = std::sqrt(distance_m * distance_m + kEquatorialRadius_m * kEquatorialRadius_m -
                                     2 * distance_m * kEquatorialRadius_m * std::cos(nearest_rad));
        const double mu = std::max(0.02, (distance_m * std::cos(nearest_rad) - kEquatorialRadius_m) / d_m);
        // A lookup is as wide as the shorter side of a footprint, and at least an eighth of the longer
        // (map_looks.h). Oblique views make footprints long, and so do columns that converge towards a pole.
        const double width_m = static_cast<double>(kTexelOfLook) * pixel_rad * d_m *
                               std::max({1.0, 1 / (8 * mu), 1 / (8 * cap.cosine)});
        // Distances on the stretched Earth are off by 1/300.
        constexpr double kMargin = 0.02;
        return std::max(0.0, std::log2(width_m / texel_m) - kMargin) + coarser_by;
    }
};

DetailNeed::DetailNeed(const EarthDetail::Shape& shape, std::size_t most) : shape_(shape), most_(most) {
    tiles_.reserve(most + 1);
}

void DetailNeed::find(const DetailView& view) {
    Sight sight(view);
    constexpr double kStep = 0.5;
    for (; sight.coarser_by < shape_.levels + 1.0; sight.coarser_by += kStep)
        if (collect(sight)) break;
    coarser_by_ = sight.coarser_by;
}

// Collects level by level, from the children of the tiles that were found. Returns false if there are too
// many.
bool DetailNeed::collect(const Sight& sight) {
    tiles_.clear();
    const int top = shape_.levels - 1;
    for (int row = 0; row < shape_.tiles_down(top); ++row)
        for (int column = 0; column < shape_.tiles_across(top); ++column)
            if (!add_if_needed(sight, {top, column, row})) return false;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        const DetailKey parent = tiles_[i];
        if (parent.level == 0) break;
        const int level = parent.level - 1;
        // If halving rounded down, the last tile has one more child.
        const auto end = [](int at, int parents, int children) {
            return at + 1 == parents ? children : 2 * (at + 1);
        };
        const int rows = end(parent.row, shape_.tiles_down(parent.level), shape_.tiles_down(level)),
                  columns = end(parent.column, shape_.tiles_across(parent.level), shape_.tiles_across(level));
        for (int row = 2 * parent.row; row < rows; ++row)
            for (int column = 2 * parent.column; column < columns; ++column)
                if (!add_if_needed(sight, {level, column, row})) return false;
    }
    return true;
}

bool DetailNeed::add_if_needed(const Sight& sight, const DetailKey& key) {
    const Cap cap = cap_of(shape_, key);
    const double from_below_rad = angle_rad(dot(cap.middle, sight.up));
    if (from_below_rad > sight.horizon_rad + cap.radius_rad || !sight.may_see(cap)) return true;
    const double texel_m = kPi * kEquatorialRadius_m / shape_.rows;
    // A level is used by lookups up to one level finer or coarser.
    if (sight.finest_level(cap, from_below_rad, texel_m) >= key.level + 1) return true;
    if (tiles_.size() == most_) return false;
    tiles_.push_back(key);
    return true;
}

}  // namespace hilcam
