#pragma once
// Judges the values of a map by a sample of them: values that mean holes although the file does not say so,
// and heights that are radii or in another unit.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/ground/ground_raster.h"
#include "render/sky/bodies.h"

namespace hilcam {

// Returns those of -9999, -32768 and similar values that occur and stand alone: outside the range of the
// other values by more than 100, and by more than a tenth of that range.
std::vector<float> unsaid_holes(std::span<const float> raw);

// Returns why these numbers cannot be heights [m], and what to configure; empty: they can. Values that are
// not numbers are ignored. doubts: gets what is probably a mistake.
std::string judge_heights(std::span<const float> heights_m, const Figure& figure, bool whole_turn,
                          std::vector<std::string>& doubts);

}  // namespace hilcam
