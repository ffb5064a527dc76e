#pragma once
// The temperature of the Moon's ground through its day: heat in one dimension through regolith whose density
// and conductivity grow with depth and whose conductivity grows with temperature.
//
// Source: Hayne et al., J. Geophys. Res. Planets 122, 2371 (2017), appendix A, with its table A1. Slopes,
// rocks and the light of other ground are not in it.

#include <vector>

namespace hilcam {

// Names are those of the paper's table A1.
struct Regolith {
    double albedo = 0.12;     // A_0 of the highlands; maria have 0.06
    double albedo_45 = 0.06;  // a: A(theta) = A_0 + a (theta / 45 deg)^3 + b (theta / 90 deg)^8
    double albedo_90 = 0.25;  // b
    double emissivity = 0.95;
    double h_m = 0.07;  // scale of depth
    double surface_density_kg_m3 = 1100, deep_density_kg_m3 = 1800;
    double surface_conductivity_w_m_k = 7.4e-4, deep_conductivity_w_m_k = 3.4e-3;
    double radiative = 2.7;            // chi
    double inner_heat_w_m2 = 0.018;    // from below
    double day_s = 29.530589 * 86400;  // synodic
    double sun_w_m2 = 1361;            // at 1 au

    double contact_w_m_k(double depth_m) const;  // K_c; the whole conductivity is K_c (1 + chi (T / 350 K)^3)
    double density_kg_m3(double depth_m) const;
    static double heat_capacity_j_kg_k(double kelvin);  // above 1.3 K
    // Returns the share of the sunlight that is reflected, by the cosine of its zenith angle.
    double reflected(double mu0) const;
};

// Returns the surface's temperature [K] at a latitude, at `count` local times from noon on, evenly through
// the day; settled, so that one day is as the next. At the equinox. count: 24 to 100000, a multiple of 24.
std::vector<double> regolith_day_k(const Regolith& regolith, double latitude_rad, int count);

}  // namespace hilcam
