#pragma once
// Reflection and transmission of a plane layer that only scatters, with all orders of scattering, by doubling
// (van de Hulst 1963; Hansen & Travis, Space Sci. Rev. 16, 527, 1974, sec. 3.1), one Fourier mode of the
// azimuth at a time.
//
// The phase function's forward peak counts as not scattered (delta-M: Wiscombe, J. Atmos. Sci. 34, 1408,
// 1977): a share f = chi_2N of the scattering, which leaves (1 - f) tau of the optical thickness. N
// quadrature points on (0, 1).

#include <span>
#include <vector>

namespace hilcam {

struct ScatteringLayer {
    double thickness = 0;  // scaled: (1 - f) tau
    // Per mode, [view][sun] at the given cosines: for a beam of irradiance E across it, the radiance of a
    // mode is value mu0 E / pi; the total is R_0 + 2 sum R_m cos(m phi).
    std::vector<std::vector<double>> reflection, transmission;  // scattered light only
    std::vector<double> plane_albedo;                           // by sun
    std::vector<double> transmitted;                            // by sun, including the remaining direct beam
    double spherical_albedo = 0;
};

struct ScatteringLayers {
    int streams = 0;
    double forward_share = 0;             // f
    std::vector<double> scaled_moments;   // 2 N moments of the rest of the phase function
    std::vector<double> cosines;          // those that were given
    std::vector<ScatteringLayer> layers;  // thicknesses 2^k and 1.5 2^k, k = first ... last
};

// moments: of the phase function, at least 2 streams + 1. cosines: in (0, 1]. albedo: of single scattering.
// Modes are computed on all threads.
ScatteringLayers scattering_layers(std::span<const double> moments, int streams,
                                   std::span<const double> cosines, int first_power, int last_power,
                                   double albedo = 1);

// Returns sum (2 l + 1) chi_l P_l(cosine).
double phase_of_moments(std::span<const double> moments, double cosine);

}  // namespace hilcam
