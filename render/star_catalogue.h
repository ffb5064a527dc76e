#pragma once
// Stars as a catalogue gives them; positions are brought to the scenario's date once, at start-up.

#include <vector>

namespace hilcam {

struct CatalogueStar {
    int hd = 0;                      // Henry Draper number, 0: none
    double right_ascension_rad = 0;  // ICRS at the catalogue epoch
    double declination_rad = 0;      //
    double pm_ra_cosdec_rad_yr = 0;  // proper motion, mu_alpha cos(delta)
    double pm_dec_rad_yr = 0;        //
    double magnitude_v = 0;          // Johnson V
    double color_b_v = 0;            // Johnson B-V
};

struct StarCatalogue {
    double epoch_year = 1991.25;  // Julian epoch of the positions (Hipparcos: J1991.25)
    std::vector<CatalogueStar> stars;
};

}  // namespace hilcam
