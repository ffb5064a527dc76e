#pragma once
// The Earth's model of the section `earth_surface`: its maps, opened, and what of them the air above has to know.

#include <memory>

#include "render/earth/earth_model.h"

namespace hilcam {

struct EarthMaps {
    GroundMaps ground;
    CloudMaps clouds;                     // empty: those of the ground
    std::shared_ptr<EarthDetail> detail;  // null: nothing is finer
};

// config.map: not empty. Throws InputError.
EarthMaps load_earth_maps(const EarthConfig& config);
// air: null without; outlives the model.
std::shared_ptr<const EarthModel> make_earth(const EarthConfig& config, EarthMaps maps, const Atmosphere* air,
                                             const SpectralGrid& grid);

}  // namespace hilcam
