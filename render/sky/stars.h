#pragma once
// The stars of a run: their positions and light.
//
// Position: the catalogue's with proper motion from its epoch to the run's start, by ERFA's eraPmsafe without
// radial velocity, and from then on along the same straight line. Each frame sees it from the camera's
// position (annual parallax) and with the camera's velocity (stellar aberration). Not modelled: light bending
// by the Sun (4 mas at 90 degrees, 0.05 arcsec at 9), variability, orbits of double stars. Light: from V and
// colours (star_spectra.h).

#include <cstdint>
#include <vector>

#include "render/sky/star_catalogue.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/time.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The aligned member comes first, which saves a quarter of the size: there may be a hundred thousand stars.
struct Star {
    Spectrum irradiance_w_m2_um;  // at the aperture, mean over each bin
    Vec3d world_dir;              // unit, ICRF, from the barycentre at the run's start
    Vec3f motion_rad_yr;          // motion of world_dir, along the tangent
    float parallax_rad = 0;       // annual
    float magnitude_v = 0;
    std::uint32_t row = 0;  // row among the catalogue's stars, from 0
    std::uint32_t hip = 0;  // Hipparcos number; 0: none
    std::uint32_t hd = 0;   // Henry Draper number; 0: none
};
static_assert(sizeof(Star) == 96);

// The position and velocity from which the stars are seen: relative to the barycentre of the Solar System,
// ICRF axes.
class StarObserver {
  public:
    StarObserver() = default;
    // years: Julian, since the epoch of the stars' positions.
    StarObserver(double years, Vec3d position_m, Vec3d velocity_m_s);

    // Returns the apparent direction, unit, ICRF. Stellar aberration is that of aberrated(), ERFA's eraAb,
    // without the call: a frame may look at a hundred thousand stars. Loop, any thread.
    Vec3d apparent_dir(const Star& star) const {
        const Vec3d from_here = normalized(displaced(star));
        const double along = dot(from_here, beta_);
        return normalized(inverse_lorentz_ * from_here + (1 + along / (1 + inverse_lorentz_)) * beta_);
    }
    // Returns its direction after motion and parallax, which is not a unit vector. Loop, any thread.
    Vec3d displaced(const Star& star) const {
        return star.world_dir + years_ * to_double(star.motion_rad_yr) -
               static_cast<double>(star.parallax_rad) * position_au_;
    }
    double years() const { return years_; }
    Vec3d position_au() const { return position_au_; }
    Vec3d beta() const { return beta_; }  // velocity over that of light
    double inverse_lorentz() const { return inverse_lorentz_; }

  private:
    double years_ = 0;
    Vec3d position_au_, beta_;
    double inverse_lorentz_ = 1;
};

// Returns the stars not fainter than `faintest_magnitude`, in the catalogue's order, with positions at an
// instant.
std::vector<Star> stars_at(const StarCatalogue& catalogue, TimeTai time, double faintest_magnitude,
                           const SpectralGrid& grid);
}  // namespace hilcam
