#pragma once
// A body without a model of its own as the air above it has it: one diffuse albedo by place.

#include "render/scene/scene.h"
#include "render/sky/air_by_place.h"

namespace hilcam {

// The albedo of its surface by place, as its look and its map have it; one cell without a map. A law other than Lambert's counts by its
// spherical albedo.
AirGround body_albedo(const SceneBody& body, const SpectralGrid& grid);

}  // namespace hilcam
