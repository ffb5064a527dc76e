#pragma once
// The sea: sunlight mirrored by wind-blown waves, the sky's, light that leaves the water, and foam.
//
//   slopes   Gaussian, the same along and across the wind: variance 0.003 + 0.00512 U of both together (Cox & Munk,
//            J. Opt. Soc. Am. 44, 838, 1954; U: wind at 12.5 m [m/s])
//   mirror   Fresnel's law for n = 1.34; waves hide each other by Smith's factor for Gaussian slopes (Smith, IEEE
//            Trans. Antennas Propag. 15, 668, 1967)
//   water    diffuse, Case 1 water of 0.1 mg chlorophyll m^-3 (Morel & Maritorena, J. Geophys. Res. 106, 7163, 2001),
//            the values of configs/materials/ocean.yaml, read to 15 %
//   foam     covers 2.95e-6 U^3.52 (Monahan & O'Muircheartaigh, J. Phys. Oceanogr. 10, 2094, 1980), and reflects 0.22 as
//            whitecaps of all ages do (Koepke, Appl. Opt. 23, 1816, 1984)
// What it does not model: the wind's direction and the slopes' skewness, swell, coloured coastal water, polarisation.

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Unpolarised reflectance of a smooth surface of water in air. cosine: of the angle of incidence, 0..1.
float water_fresnel(float cosine);

class Sea {
  public:
    Sea(double wind_m_s, const SpectralGrid& grid);

    double slope_variance() const { return variance_; }
    double foam_share() const { return foam_; }
    // Radiance that mirrors the Sun, per unit of its irradiance across the beam [sr^-1]. mu0, mu: cosines of the zenith
    // angles of Sun and viewer, cos_phase: of the angle between the two. Zero where either is below the horizon.
    float glint_sr(float mu0, float mu, float cos_phase) const;
    // Returns what is mirrored of an even sky: radiance over radiance.
    float sky_mirrored(float mu) const;
    // Returns the part of light that comes from above: radiance times pi over irradiance.
    const Spectrum& diffuse() const { return diffuse_; }
    // All that it sends up again of an even sky's light, about.
    const Spectrum& albedo() const { return albedo_; }

  private:
    double variance_, foam_;
    float sigma_;  // deviation of slopes along one axis
    Spectrum diffuse_, albedo_;

    float shadowing(float mu) const;
};

}  // namespace hilcam
