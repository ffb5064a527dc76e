#pragma once
// Finds pixels that the Earth's limb passes, or that of its clouds, which extend beyond it: one look through
// the pixel's middle cannot find such an edge.

#include <algorithm>
#include <cmath>

#include "render/background/background.h"
#include "render/earth/earth_model.h"
#include "render/sky/bodies.h"

namespace hilcam {

class EarthLimbs {
  public:
    // The Earth, placed, and its model.
    EarthLimbs(const PlacedBody& earth, const EarthModel& model) : earth_(earth), model_(model) {}

    // True when a limb is within this angle of a direction (world, unit).
    bool near(Vec3d dir, double within_rad) const {
        const double from_middle_rad = std::acos(std::clamp(dot(dir, earth_.world_dir), -1.0, 1.0));
        if (!may_be_near(from_middle_rad, within_rad)) return false;
        const Vec3d across = dir - dot(dir, earth_.world_dir) * earth_.world_dir;
        if (!(length(across) > 1e-9)) return true;
        const Vec3d axis = earth_.fixed_from_world * earth_.world_dir,
                    way = earth_.fixed_from_world * normalized(across);
        const auto near_level = [&](double height_m) {
            const double seen_m = model_.seen_height_m(height_m);
            const Figure level{earth_.figure.equatorial_radius_m + seen_m,
                               earth_.figure.polar_radius_m + seen_m};
            return std::abs(from_middle_rad - limb_angle_rad(level, earth_.camera_m, axis, way)) < within_rad;
        };
        return near_level(0) || (model_.has_clouds() && near_level(EarthModel::kCloudLevel_m));
    }

  private:
    const PlacedBody& earth_;
    const EarthModel& model_;

    // A coarse test. The limb differs from a circle by the flattening (1/300 of the radius) and by the
    // clouds' level; directions farther from the circle than that cannot be near a limb.
    bool may_be_near(double from_middle_rad, double within_rad) const {
        constexpr double kFlattening = 0.0034;
        const double disk_rad = std::acos(earth_.disk_cosine);
        const double per_radius_rad =
            std::sqrt(1 - earth_.disk_cosine * earth_.disk_cosine) / std::max(0.1, earth_.disk_cosine);
        const double level = EarthModel::kCloudLevel_m / earth_.figure.equatorial_radius_m;
        return from_middle_rad > disk_rad - kFlattening * per_radius_rad - within_rad &&
               from_middle_rad < disk_rad + 2 * level * per_radius_rad + within_rad;
    }
};

}  // namespace hilcam
