#pragma once
// The figure of the Earth's models: bodies.h has it for all bodies.

#include "render/sky/bodies.h"

namespace hilcam {

inline constexpr Figure kEarthFigure = kFigures[index_of(BodyId::kEarth)];

}  // namespace hilcam
