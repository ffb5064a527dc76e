#pragma once
// Reads measured BRDFs: MERL's binary format, and hilcam's own CSV (docs/materials.md).
//
// CSV: the header `theta_i_deg,phi_deg,theta_o_deg,wavelength_um,brdf_sr`, then one value per line, in any
// order, for every combination of the angles and wavelengths that occur. theta_i is the light's, theta_o the
// viewer's, phi the azimuth between them: 0 on the same side (back to the light), 180 opposite. phi covers 0
// to 180 and the others 0 to 90, unless a line `# hold` extends the values at the last theta to 90. The
// wavelengths cover the run's.
//
// MERL (Matusik et al. 2003): three int32 (90 90 180), then red, green and blue as doubles. The three colours
// are mapped to the bins in the same way as pictures (render/scene/color_bands.h). Negative values mark what
// was not measured; they become 0.

#include <filesystem>

#include "render/brdf/brdf_table.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Reads .csv or .binary, selected by the file's ending. Throws InputError with file, line and what is
// missing.
BrdfTable read_brdf(const std::filesystem::path& file, const SpectralGrid& grid);

}  // namespace hilcam
