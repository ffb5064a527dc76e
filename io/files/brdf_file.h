#pragma once
// Measured BRDFs from files: MERL's binary format, and a CSV of our own (docs/materials.md).
//
// CSV: a header line `theta_i_deg,phi_deg,theta_o_deg,wavelength_um,brdf_sr`, then one value a line, in any
// order, for every combination of the angles and wavelengths that occur. theta_i of the light, theta_o of the
// viewer, phi the azimuth between them: 0 on the same side (back to the light), 180 opposite. phi reaches
// from 0 to 180, the others from 0 to 90, unless a line `# hold` allows the last theta's values to be kept up
// to 90. The wavelengths cover the run's. MERL (Matusik et al. 2003): three int32 (90 90 180), then red,
// green and blue as doubles; the three colours are laid on the bins as pictures are
// (render/scene/color_bands.h); negative values, which mark what was not measured, become 0.

#include <filesystem>

#include "render/brdf/brdf_table.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Reads the file by its ending: .csv or .binary. Throws InputError with file, line and what is missing.
BrdfTable read_brdf(const std::filesystem::path& file, const SpectralGrid& grid);

}  // namespace hilcam
