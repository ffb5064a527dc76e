#pragma once
// The optical properties of air, per spectral bin, as functions of height.
//
//   Rayleigh  optical depth of Bodhaine et al., J. Atmos. Oceanic Technol. 16 (1999), eq. 30 (1013.25 hPa,
//   360 ppm CO2),
//             times pressure; exponential, scale height 8.0 km; phase 3/16pi (1 + cos^2)
//   aerosol   Angstrom's law, exponential; Cornette & Shanks' phase function (Applied Optics 31, 1992)
//   ozone     absorption only: cross sections of Serdyuchenko et al., Atmos. Meas. Tech. 7 (2014), at 233 K,
//   0.36 to
//             0.83 um (held below, none above); a triangle from 10 to 40 km with its top at 25 km
// Coefficients are means over a bin, so transmittances of wide bins err where they vary much inside one.
// Not modelled: water vapour and oxygen bands, refraction, polarisation, clouds.

#include "render/sky/atmosphere_config.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Vertical optical depth of the molecules at 1013.25 hPa; 0.25-4 um.
double rayleigh_optical_depth(double wavelength_um);

struct AirAt {
    Spectrum rayleigh;    // scattering [1/m]
    Spectrum aerosol;     // scattering [1/m]
    Spectrum extinction;  // [1/m]
};

class AirPhysics {
  public:
    static constexpr double kTop_m = 100e3;
    static constexpr double kRayleighHeight_m = 8000;

    AirPhysics(const AtmosphereConfig& config, const SpectralGrid& grid);

    AirAt at(double height_m) const;
    float rayleigh_phase(float cosine) const;
    float aerosol_phase(float cosine) const;

  private:
    Spectrum rayleigh_, aerosol_scattering_, aerosol_extinction_, ozone_;  // ozone: at its top
    double aerosol_height_m_;
    float asymmetry_;
};

}  // namespace hilcam
