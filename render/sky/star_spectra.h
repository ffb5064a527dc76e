#pragma once
// The spectra of stars by V, V-Ic and B-V.
//
// A star gets a mix of two spectra of Pickles' library (PASP 110, 863, 1998; tools/make_star_spectra.py says
// which of its spectra are used and how they are processed): the two with the nearest V-Ic (Cousins' I), as a
// weighted geometric mean. From 0.53 um to the blue the result is tilted, fully from 0.44 um on, so that B-V
// is right, too; dwarfs, giants and reddened stars of one V-Ic differ most there. Its mean over V (Bessell,
// PASP 102, 1181, 1990) is 3.631e-8 W m^-2 um^-1 for V = 0, and over Ic 1.126e-8 for Ic = 0 (Bessell,
// Castelli & Plez, A&A 333, 231, 1998, table A2).
//
// If V-Ic is unknown, it follows from B-V: B-V of the classes, dwarfs to K0 and giants from G8 on, by
// Schmidt-Kaler (Landolt-Boernstein VI/2b, 1982), and V-Ic of the same types in the library. From B-V 1.5 on
// that is a weak estimate: giants of B-V 1.6 have V-Ic from 1.7 (M0) to 2.9 (M5).
//
// A spectrum by these colours is right within 0.02 mag in B, V and Ic; in narrow bands within 0.1 mag for
// stars to K5 and 0.3 for M stars, whose molecular bands do not follow from colour alone. Not modelled:
// dust; effects of a star's own metallicity, emission lines or variability; lines finer than 10 nm.

#include <optional>
#include <vector>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Returns V-Ic of a star of a B-V [mag].
double v_i_of_b_v(double b_v);

class StarSpectra {
  public:
    // Owner thread.
    explicit StarSpectra(const SpectralGrid& grid);

    struct Colors {
        double b_v = 0;
        std::optional<double> v_i;  // none: derived from B-V
    };
    // Returns the bin means of a star's spectral irradiance [W m^-2 um^-1]. Any thread.
    Spectrum irradiance_w_m2_um(double magnitude_v, const Colors& colors) const;

  private:
    SpectralGrid grid_;
    std::vector<Spectrum> logs_;  // by star of the library: logarithms of its bin means
    std::vector<float> blue_;     // by bin: weight of the tilt in the blue
};

}  // namespace hilcam
