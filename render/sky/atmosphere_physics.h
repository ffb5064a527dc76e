#pragma once
// The optical properties of air per spectral bin, as functions of height.
//
//     molecules  optical depth of Bodhaine et al., J. Atmos. Oceanic Technol. 16 (1999), eq. 30 (1013.25 hPa,
//                360 ppm CO2), times pressure; density by height of the U.S. Standard Atmosphere 1976
//                (standard_air.h); phase 3/16pi (1 + cos^2)
//     aerosol    Angstrom's law, exponential in height; Cornette & Shanks' phase function (Applied Optics 31,
//                1992)
//     ozone      absorption only: cross sections of Serdyuchenko et al., Atmos. Meas. Tech. 7 (2014), at
//                233 K, 0.36 to 0.83 um (constant below, none above); by height as in the same standard,
//                scaled to its column
// Coefficients are means over a bin, so transmittances of wide bins are wrong if the coefficients vary much
// inside one. Not modelled: water vapour and oxygen bands, polarisation, clouds, seasons. Refraction is in
// air_refraction.h.

#include <vector>

#include "render/sky/atmosphere_config.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Returns the vertical optical depth of the molecules at 1013.25 hPa; 0.25-4 um.
double rayleigh_optical_depth(double wavelength_um);

struct AirAt {
    Spectrum rayleigh;    // scattering [1/m]
    Spectrum aerosol;     // scattering [1/m]
    Spectrum extinction;  // [1/m]
};

class AirPhysics {
  public:
    static constexpr double kTop_m = 100e3;

    AirPhysics(const AtmosphereConfig& config, const SpectralGrid& grid);

    // Loop, any thread.
    AirAt at(double height_m) const;
    float rayleigh_phase(float cosine) const;
    float aerosol_phase(float cosine) const;

  private:
    // Shares of the columns of molecules and ozone per metre, at equal steps of height.
    struct Shares {
        float air_m, ozone_m;
    };
    std::vector<Shares> shares_;
    Spectrum rayleigh_, ozone_;                         // vertical optical depths
    Spectrum aerosol_scattering_, aerosol_extinction_;  // at the ground [1/m]
    double aerosol_height_m_;
    float asymmetry_;
};

}  // namespace hilcam
