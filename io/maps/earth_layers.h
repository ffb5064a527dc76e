#pragma once
// Combines the user's maps with a packed map of the Earth. What is as coarse as the packed map is written
// into it; finer detail is read in tiles, where a picture looks.

#include <memory>
#include <vector>

#include "io/maps/earth_layer_raster.h"
#include "render/earth/earth_config.h"
#include "render/earth/earth_detail.h"

namespace hilcam {

struct LayeredEarth {
    EarthMap map;
    std::shared_ptr<EarthDetail> detail;  // null: no layer is finer
};

// Opens the layers. Throws InputError as EarthLayerRaster does, and when a layer cannot be read at the map's
// texels.
LayeredEarth with_layers(EarthMap map, const std::vector<EarthLayerConfig>& layers);
// Combines layers that are open.
LayeredEarth with_layers(EarthMap map, std::vector<EarthLayerRaster> layers);

}  // namespace hilcam
