#pragma once
// Reads tables of an atmosphere (docs/atmosphere.md): hilcam's own CSV, or MODTRAN runs.
//
// CSV: a header with these columns in this order: sun_zenith_deg, view_zenith_deg, azimuth_deg, height_km,
// wavelength_um, tau_1, tau_2, path_radiance_sr, sky_irradiance, then a line for every combination of values.
// Radiance [sr^-1] and sky irradiance [1] are per unit of solar irradiance.
//
// MODTRAN: a CSV with the header `sun_zenith_deg,view_zenith_deg,azimuth_deg,height_km,file` and a line for
// each run. The files are its text tables (tape7.scn) in the same folder. Their columns are found by name:
// WAVLEN (nm) or FREQ (cm^-1), TOT_TRANS, SOL_SCAT, SOL@OBS, TOA_SUN and, for the sky, GRND_RFLT and
// DRCT_RFLT with the run's surface albedo.

#include <filesystem>

#include "render/sky/atmosphere_table.h"

namespace hilcam {

// Throws InputError with file, line and what is missing.
AtmosphereTable read_atmosphere(const std::filesystem::path& file, const SpectralGrid& grid);

}  // namespace hilcam
