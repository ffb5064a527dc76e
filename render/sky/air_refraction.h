#pragma once
// Refraction: how a ball of air bends rays of light.
//
// The air is layered, so n r sin(z) stays the same along a ray (Bouguer), z being its angle from the vertical: this is its impact radius a.
// Outside the air it is the distance at which the ray would pass the middle if nothing bent it. A ray turns by
// a integral of (-d ln n / dx) / sqrt(x^2 - a^2) dx, x = n r, on either side of its lowest point (Fjeldbo, Kliore & Eshleman, Astron. J.
// 76, 123, 1971, eq. A7). That is summed up over thin layers once; frames look it up by the height of the lowest point.
//
// From another point than its lowest a ray turns by what air of the same turn along the level and of the same density there makes if it is
// exponential: sqrt(a) erfcx(q), q^2 = (x^2 - a^2) / (2 a H) (Goldsmith, Planet. Space Sci. 11, 711, 1963), erfcx by Ren & MacKenzie,
// Electron. Lett. 43, 1112 (2007). From the ground this is within 0.6 % of the sum at any height.
//
// Lengths [m] from the middle of the ball. Directions are unit vectors. const functions: loop, any thread.

#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Refractivity n - 1 of dry air at 15 deg C and 1013.25 hPa: Ciddor, Appl. Opt. 35, 1566 (1996), eq. 1.
double air_refractivity(double wavelength_um);
// The mean of the above over the middles of bins.
double air_refractivity(const SpectralGrid& grid);

class AirRefraction {
  public:
    // density: over that of the air of which the refractivity is, by height over the ground [m]; nothing is above top_m. Between whole
    // kilometres turns are cubic, so corners of a density's layers are rounded.
    AirRefraction(double refractivity, double (*density)(double height_m), double ground_m, double top_m);

    struct Line {
        Vec3d origin_m, dir;
    };
    // A bent ray, told by two straight ones. The first meets the ground where it does and as steeply, or else has its lowest point and is
    // turned there as it is; the second is its way behind the air, or the first where it meets the ground.
    Line within(Vec3d origin_m, Vec3d dir) const;
    Line beyond(Vec3d origin_m, Vec3d dir) const;

    // Where a point is seen that is outside the air, and by how much the air makes its light more than nothing would: less than 1, as rays
    // from it are spread. distance_m may be infinite. A point that the ball hides is left where it is.
    struct Seen {
        Vec3d dir;
        double light = 1;
    };
    Seen seen_at(Vec3d origin_m, Vec3d dir, double distance_m) const;

    // The height at which a level seems to be from afar [m].
    double apparent_height_m(double height_m) const;
    // No ray turns by more.
    double max_turn_rad() const { return max_turn_rad_; }

  private:
    // By height of the lowest point, a kilometre apart.
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

// The same in the axes of a flattened body, stretched as for Atmosphere; directions of any length, which they keep.
AirRefraction::Line line_within(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir);
AirRefraction::Line line_beyond(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir);
AirRefraction::Seen seen_through(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir,
                                 double distance_m);

}  // namespace hilcam
