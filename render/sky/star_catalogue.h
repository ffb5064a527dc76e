#pragma once
// Stars as a catalogue gives them. Positions and motions are ICRS, seen from the barycentre of the Solar
// System.

#include <optional>
#include <vector>

namespace hilcam {

struct CatalogueStar {
    int hip = 0;                      // Hipparcos number, 0: none
    int hd = 0;                       // Henry Draper number, 0: none
    double right_ascension_rad = 0;   // at the epoch
    double declination_rad = 0;       //
    double epoch_year = 1991.25;      // Julian year of the position (Hipparcos: J1991.25)
    double pm_ra_cosdec_rad_yr = 0;   // proper motion, mu_alpha cos(delta)
    double pm_dec_rad_yr = 0;         //
    double parallax_rad = 0;          // annual; 0: unknown, or too far away
    double magnitude_v = 0;           // Johnson V
    double color_b_v = 0;             // Johnson B-V
    std::optional<double> color_v_i;  // V-I with Cousins' I; none: unknown
};

struct StarCatalogue {
    std::vector<CatalogueStar> stars;
    bool tells_red_stars =
        false;  // has V-I or spectral classes; without them the colour of M stars follows from B-V
};

}  // namespace hilcam
