#pragma once
// Mountains and valleys of a round body: heights above its sphere on an equirectangular grid.
//
// Rays meet the relief itself, so the limb has its profile. The ground has the normal of its slope over a
// footprint, and terrain in front of the Sun shadows it, with the penumbra of the Sun's disk. Heights are
// bilinear between grid points, or come from coarser levels if a footprint is wider than the spacing. What is
// finer than the grid belongs to the surface law (Hapke's roughness). Not modelled: light between slopes.
//
// Body axes, metres from its centre. Rows go from 90 N to 90 S, columns from 180 W eastward; a value is at
// the middle of its cell.

#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

class BodyRelief {
  public:
    BodyRelief() = default;  // no relief
    // heights_m: width x height values. HILCAM_CHECK: at least 8 x 4, all finite and above -radius / 2. Owner
    // thread.
    BodyRelief(double radius_m, int width, int height, std::vector<float> heights_m);

    bool empty() const { return levels_.empty(); }
    double highest_m() const { return highest_m_; }
    double lowest_m() const { return lowest_m_; }
    // Returns the grid spacing at the equator.
    double spacing_m() const { return spacing_m_; }
    std::size_t bytes() const {
        std::size_t values = 0;
        for (const Level& level : levels_) values += level.height_m.size();
        return values * sizeof(float);
    }

    // All functions below: loop, any thread. dir: unit, from the centre. footprint_m: 0 uses the grid as it
    // is.
    double height_m(Vec3d dir, double footprint_m = 0) const;
    Vec3d normal(Vec3d dir, double footprint_m) const;
    // Returns the distance from a place outside along a unit direction to the ground; negative: it misses.
    double intersect(Vec3d origin_m, Vec3d dir) const;
    // Returns the angle [rad] above a place's level (the tangent plane of its sphere) up to which ground
    // rises in a direction, as far as it matters for a Sun no higher than `highest_rad`.
    double horizon_rad(Vec3d place_m, Vec3d towards_dir, double highest_rad) const;
    // Returns the share of a Sun of this angular radius that a place sees, 0..1.
    double sun_share(Vec3d place_m, Vec3d sun_dir, double sun_radius_rad) const;

  private:
    struct Level {
        int width, height;
        std::vector<float> height_m;
    };
    double at(const Level& level, double u, double v) const;

    double radius_m_ = 0, spacing_m_ = 0, highest_m_ = 0, lowest_m_ = 0;
    std::vector<Level> levels_;
};

// Returns the share of a disk of radius 1 above a straight edge at -1 <= x <= 1 below its middle: 1 at x = 1,
// 0 at -1.
double share_above(double x);

}  // namespace hilcam
