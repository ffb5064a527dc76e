#pragma once
// The transmittance of a ball of air: a table of transmittances to space by height and direction, from
// atmosphere_physics.h, and the Sun's beam from it. Also the coordinates of tables by height and by the Sun's
// cosine.
//
// Radii [m] are those of a ball with the Earth's equatorial radius; mu and mu_s are cosines between the
// outward vertical and a ray or the Sun. const functions: loop, any thread.

#include "render/sky/atmosphere_physics.h"
#include "render/sky/spectrum_table.h"
#include "render/vocabulary/units.h"

namespace hilcam {

struct AirBall {
    static constexpr double kGround_m = kEarthEquatorialRadius_m;
    static constexpr double kTop_m = kGround_m + AirPhysics::kTop_m;

    // Distances along a ray from radius r.
    static double to_sphere_far(double r, double mu, double radius);
    static bool meets_ground(double r, double mu) {
        return mu < 0 && r * r * (mu * mu - 1) + kGround_m * kGround_m >= 0;
    }
    static double to_ground(double r, double mu);

    // The square root makes the lowest kilometres denser.
    static double height_coordinate(double r);
    static double height_at(double v) { return kGround_m + v * v * AirPhysics::kTop_m; }
    // The Sun's cosine, denser near the horizon.
    static double sun_coordinate(double mu_s);
    static double sun_at(double u);
};

class AirTransmittance {
  public:
    AirTransmittance() : table_(256, 64) {}
    void fill(const AirPhysics& air);
    SpectrumTable& table() { return table_; }

    // Returns the transmittance from a point to the Sun; zero below the horizon, softened by the Sun's disk.
    Spectrum to_sun(double r, double mu_s) const;

  private:
    SpectrumTable table_;  // by direction, then height

    Spectrum to_space(double r, double mu) const;
};

}  // namespace hilcam
