#pragma once
// Converts colours of maps to the land's reflectance in the bands of land.h. tools/make_earth_map.py has the
// same laws and the origin of their figures; tests/sky/earth_map_tool_test.py compares the two.

#include <array>

#include "render/vocabulary/vec.h"

namespace hilcam {

using BandReflectances = std::array<float, 4>;  // blue, green, red, near infrared, 0..1

// Converts reflectances in red, green and blue (x, y, z). The near infrared is estimated from them: green
// against red separates plants from soil, blue against red identifies snow.
BandReflectances bands_of_reflectances(Vec3f rgb);
// Converts linear colours of NASA's Blue Marble, which is stretched for the eye: power laws between forest,
// sand and snow.
BandReflectances bands_of_blue_marble(Vec3f rgb);

}  // namespace hilcam
