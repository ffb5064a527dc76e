#pragma once
// Refraction: how a sphere of air bends rays of light.
//
// The air consists of spherical layers, so n r sin(z) is constant along a ray (Bouguer), with its angle z
// from the vertical. This constant is the impact radius a: outside the air, the distance at which the ray
// would pass the middle if it were straight. On either side of its lowest point a ray turns by
//     a integral of (-d ln n / dx) / sqrt(x^2 - a^2) dx,   x = n r
// (Fjeldbo, Kliore & Eshleman, Astron. J. 76, 123, 1971, eq. A7). The constructor sums it over thin layers;
// frames look it up by the impact radius.
//
// From a point above its lowest one a ray turns as in exponential air with the same density at that point and
// the same turn of a level ray: by sqrt(a) erfcx(q), q^2 = (x^2 - a^2) / (2 a H), up to a factor (Goldsmith,
// Planet. Space Sci. 11, 711, 1963). erfcx is that of Ren & MacKenzie, Electron. Lett. 43, 1112 (2007). From
// the ground this is within 0.6 % of the sum at any height.
//
// Lengths [m] are from the middle of the sphere. Directions are unit vectors. const functions: loop, any
// thread.

#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns the refractivity n - 1 of dry air at 15 deg C and 1013.25 hPa: Ciddor, Appl. Opt. 35, 1566 (1996),
// eq. 1.
double air_refractivity(double wavelength_um);
// Returns the mean refractivity over the middles of the bins.
double air_refractivity(const SpectralGrid& grid);

class AirRefraction {
  public:
    // density: by height above the ground [m], relative to air of this refractivity; zero above top_m. Turns
    // are cubic between whole kilometres, which rounds corners of the density.
    AirRefraction(double refractivity, double (*density)(double height_m), double ground_m, double top_m);

    struct Line {
        Vec3d origin_m, dir;
    };
    // Two straight lines stand for a bent ray. within() meets the ground where the ray does and as steeply,
    // or has the ray's lowest point and its direction there. beyond() is the ray behind the air, or within()
    // if the ray meets the ground.
    Line within(Vec3d origin_m, Vec3d dir) const;
    Line beyond(Vec3d origin_m, Vec3d dir) const;

    // The direction in which a point outside the air is seen, and its light relative to that without air:
    // below 1, because the air spreads the rays. distance_m may be infinite. A hidden point keeps its
    // direction.
    struct Seen {
        Vec3d dir;
        double light = 1;
    };
    Seen seen_at(Vec3d origin_m, Vec3d dir, double distance_m) const;

    // Returns the height at which an observer far away sees a level [m].
    double apparent_height_m(double height_m) const;
    // Returns the largest turn of any ray.
    double max_turn_rad() const { return max_turn_rad_; }

  private:
    // Rays by the height of their lowest point, a kilometre apart.
    struct Level {
        double impact_m, height_m, turn_rad;  // turn: from the lowest point to space
        double height_slope, turn_slope;      // per impact_m
        double refractivity;
    };
    struct Turn {
        double rad, slope;  // slope: per impact_m or radian
    };
    struct Lowest {
        double height_m;
        Turn turn;
    };
    struct Observer;
    struct Way;

    std::vector<Level> levels_;
    double ground_m_, top_m_, max_turn_rad_;

    double edge_m() const { return levels_.front().impact_m; }
    Lowest lowest(double impact_m) const;
    double refractivity_at(double radius_m) const;
    double turn_outwards(const Observer& from, double impact_m) const;
    Way way_of(Vec3d origin_m, Vec3d dir) const;
    Turn turn_seen(const Observer& from, double nadir_rad) const;
    void sum_turns(double refractivity, double (*density)(double height_m));
};

// The same in the axes of a flattened body, stretched as for Atmosphere. Directions have any length and keep
// it.
AirRefraction::Line line_within(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir);
AirRefraction::Line line_beyond(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir);
AirRefraction::Seen seen_through(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir,
                                 double distance_m);

}  // namespace hilcam
