#pragma once
// The sea: sunlight and sky mirrored by wind-blown waves, light that leaves the water, and foam.
//
//     slopes   Gaussian, equal along and across the wind: total variance 0.003 + 0.00512 U (Cox & Munk,
//              J. Opt. Soc. Am. 44, 838, 1954; U: wind at 12.5 m [m/s])
//     mirror   Fresnel's law for n = 1.34; waves hide each other by Smith's factor for Gaussian slopes
//              (Smith, IEEE Trans. Antennas Propag. 15, 668, 1967)
//     water    diffuse, Case 1 water of 0.1 mg chlorophyll m^-3 (Morel & Maritorena, J. Geophys. Res. 106,
//              7163, 2001), the values of configs/materials/ocean.yaml, read to 15 %
//     foam     covers 2.95e-6 U^3.52 (Monahan & O'Muircheartaigh, J. Phys. Oceanogr. 10, 2094, 1980) and
//              reflects 0.22, as whitecaps of all ages do (Koepke, Appl. Opt. 23, 1816, 1984)
// Not modelled: the wind's direction and the skewness of slopes, swell, coloured coastal water, polarisation.

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Returns the unpolarised reflectance of a smooth water surface in air. cosine: of the angle of incidence,
// 0..1.
float water_fresnel(float cosine);

class Sea {
  public:
    Sea(double wind_m_s, const SpectralGrid& grid);

    double slope_variance() const { return variance_; }
    double foam_share() const { return foam_; }
    // Returns the mirrored radiance of the Sun, per unit of its irradiance across the beam [sr^-1]. mu0, mu:
    // cosines of the zenith angles of Sun and viewer; cos_phase: of the angle between the two. Zero if either
    // is below the horizon.
    float glint_sr(float mu0, float mu, float cos_phase) const;
    // Returns the mirrored share of a uniform sky: radiance over radiance.
    float sky_mirrored(float mu) const;
    // Returns the diffuse reflectance for light from above: radiance times pi over irradiance.
    const Spectrum& diffuse() const { return diffuse_; }
    // Returns roughly the total share of a uniform sky's light that is reflected.
    const Spectrum& albedo() const { return albedo_; }

  private:
    double variance_, foam_;
    float sigma_;  // standard deviation of slopes along one axis
    Spectrum diffuse_, albedo_;

    float shadowing(float mu) const;
};

}  // namespace hilcam
