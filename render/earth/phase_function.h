#pragma once
// Phase functions of a cloud's particles, normalised to a mean of 1 over all directions, and their Legendre
// moments.
//
//     Henyey & Greenstein, Astrophys. J. 93, 70 (1941)
//     Water droplets by Mie's theory (Bohren & Huffman, Absorption and Scattering of Light by Small
//     Particles, 1983, ch. 4), over a gamma distribution of radii (Hansen, J. Atmos. Sci. 28, 1400, 1971)
//     given by effective radius and variance. This has the bow and the glory.

#include <cstddef>
#include <vector>

namespace hilcam {

class PhaseFunction {
  public:
    // g: asymmetry, in (-1, 1).
    static PhaseFunction henyey_greenstein(double g);
    // n: real refractive index; droplets do not absorb. width_um: of the spectral bin around the wavelength,
    // over which the rings of the glory are averaged. Takes some tens of milliseconds.
    static PhaseFunction droplets(double wavelength_um, double width_um, double n, double effective_radius_um,
                                  double effective_variance);

    // theta_rad: scattering angle, 0..pi. Linear between tabulated angles, which are denser at both ends.
    float at(float theta_rad) const;
    // Returns chi_l = mean of P P_l, l = 0 ... count - 1; chi_0 = 1, chi_1 = g.
    std::vector<double> moments(std::size_t count) const;

    static constexpr int kAngles = 361;
    static double angle_rad(int i);
    // Returns an angle's position among the tabulated ones.
    static float place(float theta_rad);

  private:
    std::vector<double> value_;  // at angle_rad(i)

    explicit PhaseFunction(std::vector<double> values);
};

// Returns the refractive index of water, 0.35 to 1.05 um: Hale & Querry, Appl. Opt. 12, 555 (1973).
double water_index(double wavelength_um);

}  // namespace hilcam
