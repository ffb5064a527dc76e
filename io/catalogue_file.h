#pragma once
// Star catalogues as CSV: `hd,ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,v_mag,b_v`, lines starting with #
// are comments.

#include <filesystem>

#include "render/star_catalogue.h"

namespace hilcam {

// ICRS at J1991.25 . pm_ra includes cos(dec). Throws InputError with file:line for what is not a
// row.
StarCatalogue load_catalogue(const std::filesystem::path& file);

}  // namespace hilcam
