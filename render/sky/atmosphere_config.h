#pragma once
// A scenario's description of the Earth's air.

#include <filesystem>
#include <string>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct AtmosphereConfig {
    std::string model = "none";
    // Keys of `precomputed`.
    double pressure_pa = 101325;          // at the ground
    double aerosol_optical_depth = 0.10;  // vertical, at 0.55 um
    double angstrom_exponent = 1.3;       // tau ~ wavelength^-exponent
    double aerosol_scale_height_m = 1500;
    double aerosol_asymmetry = 0.70;  // g of the Cornette-Shanks phase function
    double aerosol_single_albedo = 0.92;
    double ozone_du = 300;
    double ground_albedo = 0.25;     // for light reflected between ground and sky, if nothing else gives it
    bool has_ground_albedo = false;  // given: it counts, whatever the Earth looks like
    std::filesystem::path cache;     // folder of the tables; empty: the user's cache folder
    // Keys of `table`.
    std::filesystem::path table;  // CSV or MODTRAN tape7.scn, see docs/atmosphere.md
};
Fields fields(AtmosphereConfig& config);
void validate(const AtmosphereConfig& config);

}  // namespace hilcam
