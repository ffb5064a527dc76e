#pragma once
// Loads a body from its section of a scenario: its look, and its maps of albedo and heights, opened.

#include <string>

#include "render/scene/scene.h"
#include "render/sky/body_photometry.h"

namespace hilcam {

// name: name of the section, for messages. Throws InputError.
SceneBody load_body(BodyId id, const std::string& name, const Figure& figure, const BodyConfig& config,
                    const SpectralGrid& grid);

}  // namespace hilcam
