#pragma once
// The ground of a body without a model of its own, for the air above it: a diffuse albedo by place.

#include "render/scene/scene.h"
#include "render/sky/air_by_place.h"

namespace hilcam {

// Returns the albedo of its surface by place, from its look and map; a single cell without a map. Laws other
// than Lambert's count by their spherical albedo.
AirGround body_albedo(const SceneBody& body, const SpectralGrid& grid);

}  // namespace hilcam
