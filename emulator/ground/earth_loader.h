#pragma once
// Loads the Earth's model from the section `earth_surface`: its maps, opened, and what the atmosphere needs
// of them.

#include <memory>

#include "render/earth/earth_model.h"

namespace hilcam {

struct EarthMaps {
    GroundMaps ground;
    CloudMaps clouds;                     // empty: the ground's own clouds
    std::shared_ptr<EarthDetail> detail;  // null: no finer detail
};

// config.map must not be empty. Throws InputError.
EarthMaps load_earth_maps(const EarthConfig& config);
// air: null when there is no atmosphere; must outlive the model.
std::shared_ptr<const EarthModel> make_earth(const EarthConfig& config, EarthMaps maps, const Atmosphere* air,
                                             const SpectralGrid& grid);

}  // namespace hilcam
