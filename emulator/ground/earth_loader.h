#pragma once
// The Earth's model of the section `earth_surface`: its maps, opened.

#include <memory>

#include "render/earth/earth_model.h"

namespace hilcam {

// Null: no map. air: null without; outlives the model. Throws InputError.
std::shared_ptr<const EarthModel> load_earth(const EarthConfig& config, const Atmosphere* air,
                                             const SpectralGrid& grid);

}  // namespace hilcam
