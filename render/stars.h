#pragma once
// The stars of a run: where they stand at the scenario's date and how much light they send.
//
// Position: catalogue place plus proper motion (ERFA eraPmsafe with zero parallax and radial velocity).
// Stellar aberration (up to 20.5 arcsec) for an observer of the scenario's velocity at its start: a day later
// it has turned by a degree (0.35 arcsec). Not modelled: parallax (below 0.8 arcsec), variability,
// companions. Light: a black body of the star's colour temperature, scaled to its V magnitude at 0.55 um.
//   temperature from B-V: Ballesteros, EPL 97 (2012) 34008, eq. 14, good to a few percent from 3,000 to
//   30,000 K. V = 0: 3.63e-8 W m^-2 um^-1 at the V band (Bessell, Castelli & Plez, A&A 333, 1998, table A2).

#include <cstdint>
#include <vector>

#include "render/spectrum.h"
#include "render/star_catalogue.h"
#include "render/time.h"
#include "render/vec.h"

namespace hilcam {

struct Star {
    Vec3d world_dir;              // unit, ICRF
    Spectrum irradiance_w_m2_um;  // at the aperture, mean over each bin
    float magnitude_v = 0;
    std::uint32_t row = 0;  // of the catalogue's stars, from 0
    std::uint32_t hd = 0;   // Henry Draper number; 0: none
};

// Colour temperature [K] of a Johnson B-V index; B-V is limited to -0.4 .. 2.5, beyond which the formula runs
// away.
double color_temperature_k(double color_b_v);
// Bin means of a star's spectral irradiance [W m^-2 um^-1].
Spectrum star_irradiance_w_m2_um(double magnitude_v, double color_b_v, const SpectralGrid& grid);
// Stars not fainter than `faintest_magnitude`, brightest first as the catalogue has them.
std::vector<Star> stars_at(const StarCatalogue& catalogue, TimeTai time, Vec3d observer_velocity_m_s,
                           double faintest_magnitude, const SpectralGrid& grid);

}  // namespace hilcam
