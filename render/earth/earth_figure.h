#pragma once
// The figure that the Earth's models use; bodies.h has those of all bodies.

#include "render/sky/bodies.h"

namespace hilcam {

inline constexpr Figure kEarthFigure = kFigures[index_of(BodyId::kEarth)];

}  // namespace hilcam
