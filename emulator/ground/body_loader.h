#pragma once
// A body as its section of a scenario describes it: its look, its maps of albedo and of heights, opened.

#include <string>

#include "render/scene/scene.h"
#include "render/sky/body_photometry.h"

namespace hilcam {

// name: of the section, for messages. Throws InputError.
SceneBody load_body(BodyId id, const std::string& name, const Figure& figure, const BodyConfig& config,
                    const SpectralGrid& grid);

}  // namespace hilcam
