#pragma once
// Colours of maps as the land's reflectance in the bands of land.h. tools/make_earth_map.py has the same laws, and where its
// figures are from; tests/sky/earth_map_tool_test.py holds the two together.

#include <array>

#include "render/vocabulary/vec.h"

namespace hilcam {

using BandReflectances = std::array<float, 4>;  // blue, green, red, near infrared, 0..1

// Reflectances in red, green and blue (x, y, z), with the near infrared told from them: green against red tells plants from soil,
// blue against red tells snow.
BandReflectances bands_of_reflectances(Vec3f rgb);
// Linear colours of NASA's Blue Marble, which is stretched for the eye: power laws between forest, sand and snow.
BandReflectances bands_of_blue_marble(Vec3f rgb);

}  // namespace hilcam
