#pragma once
// This judges the values of a map by a sample of them: numbers that stand for holes without the file saying so, and heights that are radii or
// of another unit.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/ground/ground_raster.h"
#include "render/sky/bodies.h"

namespace hilcam {

// Returns which of -9999, -32768 and the like are among a file's values and stand alone: no other value is within a tenth of the others'
// range, or within 100.
std::vector<float> unsaid_holes(std::span<const float> raw);

// Judges heights [m]; what is no number is left out. Returns why they cannot be heights, and what to give; empty: they can. doubts: gets what
// is probably not meant.
std::string judge_heights(std::span<const float> heights_m, const Figure& figure, bool whole_turn,
                          std::vector<std::string>& doubts);

}  // namespace hilcam
