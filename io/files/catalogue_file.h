#pragma once
// Reads star catalogues as CSV. Lines that start with # are comments. The first other line names the columns,
// in any order: ra_deg, dec_deg and v_mag are required; hip, hd, epoch_year, pm_ra_mas_yr, pm_dec_mas_yr,
// parallax_mas, b_v, v_i and spectral_type are optional. A missing column has CatalogueStar's default: no
// number, J1991.25, no motion, far away, B-V 0. An M star without v_i has that of its class (m_stars.h);
// other stars without it have none.

#include <filesystem>

#include "render/sky/star_catalogue.h"

namespace hilcam {

// Positions are ICRS at each line's epoch; pm_ra includes cos(dec). Throws InputError with file:line and
// column for a malformed row.
StarCatalogue load_catalogue(const std::filesystem::path& file);

}  // namespace hilcam
