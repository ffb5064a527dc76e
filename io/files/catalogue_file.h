#pragma once
// Star catalogues as CSV. Lines that start with # are comments; the first other line names the columns, in
// any order: ra_deg, dec_deg and v_mag must be there; hip, hd, epoch_year, pm_ra_mas_yr, pm_dec_mas_yr,
// parallax_mas, b_v, v_i and spectral_type may be. Without a column its value is that of CatalogueStar: no number, J1991.25, no
// motion, far away, B-V 0; a line without a v_i has that of its class where it is an M star (m_stars.h), else none.

#include <filesystem>

#include "render/sky/star_catalogue.h"

namespace hilcam {

// Places are ICRS at each line's epoch; pm_ra includes cos(dec). Throws InputError with file:line and column
// for what is not a row.
StarCatalogue load_catalogue(const std::filesystem::path& file);

}  // namespace hilcam
