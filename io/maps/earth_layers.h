#pragma once
// Maps of the user's own in place of parts of a packed map of the Earth: what of them is as coarse as that map is put onto it, and what is
// finer is read by tiles, as pictures look at it.

#include <memory>
#include <vector>

#include "io/maps/earth_layer_raster.h"
#include "render/earth/earth_config.h"
#include "render/earth/earth_detail.h"

namespace hilcam {

struct LayeredEarth {
    EarthMap map;
    std::shared_ptr<EarthDetail> detail;  // null: nothing is finer
};

// Opens the layers. Throws InputError, see EarthLayerRaster, and where a layer cannot be read as far as the map has its texels.
LayeredEarth with_layers(EarthMap map, const std::vector<EarthLayerConfig>& layers);
// The same for layers that are open.
LayeredEarth with_layers(EarthMap map, std::vector<EarthLayerRaster> layers);

}  // namespace hilcam
