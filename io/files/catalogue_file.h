#pragma once
// Reads star catalogues as CSV. Lines that start with # are comments. The first other line names the columns,
// in any order: ra_deg, dec_deg and v_mag are required; hip, hd, epoch_year, pm_ra_mas_yr, pm_dec_mas_yr,
// parallax_mas, b_v and v_i are optional. A missing column has CatalogueStar's default: no number, J1991.25,
// no motion, far away, B-V 0. A star without v_i has none.

#include <filesystem>

#include "render/sky/star_catalogue.h"

namespace hilcam {

// Positions are ICRS at each line's epoch; pm_ra includes cos(dec). Throws InputError with file:line and
// column for a malformed row.
StarCatalogue load_catalogue(const std::filesystem::path& file);

}  // namespace hilcam
