#pragma once
// A measured, isotropic BRDF on a grid, converted to the run's spectral bins.
//
// There are two layouts of the grid: by angles (theta_i, phi, theta_o; phi is the azimuth between light and
// viewer, 0 on the same side), linear between grid points; or by MERL's half-vector angles (theta_h, theta_d,
// phi_d; Matusik et al., SIGGRAPH 2003), with the square root of theta_h on its axis. Values are as measured:
// reciprocity and energy conservation depend on the data. Nothing is extrapolated: readers reject a grid that
// does not reach 90 degrees unless the file says `hold` (io/files/brdf_file.h).

#include <array>
#include <vector>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

class BrdfTable {
  public:
    enum class Layout { kAngles, kHalfVector };

    // axes_rad: increasing. values[((a * n1) + b) * n2 + c] for axis indices a, b, c [sr^-1].
    BrdfTable(Layout layout, std::array<std::vector<float>, 3> axes_rad, std::vector<Spectrum> values);

    Spectrum value(float no, float ni, float io) const;
    // Returns the share of samples that are drawn from a GGX lobe of lobe_alpha(); the others follow the
    // cosine.
    float lobe_share() const { return lobe_share_; }
    float lobe_alpha() const { return lobe_alpha_; }

  private:
    Spectrum interpolate(std::array<float, 3> at_rad) const;
    void fit_lobe();

    Layout layout_;
    std::array<std::vector<float>, 3> axes_rad_;
    std::vector<Spectrum> values_;
    float lobe_share_ = 0.5f;
    float lobe_alpha_ = 0.3f;
};

}  // namespace hilcam
