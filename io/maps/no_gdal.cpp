// Stands in for hilcam-read-map where hilcam is built without GDAL (HILCAM_GDAL=OFF).

#include "io/maps/map_helper.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<GroundRaster> open_map_by_helper(const GroundMapConfig& config, const MappedBody&) {
    throw InputError(
        config.file.string() +
        ": this hilcam was built without GDAL (-DHILCAM_GDAL=OFF); accepted: pictures (.png) with "
        "bounds_deg, or a build with it");
}

std::string ended_map_readers() { return {}; }

}  // namespace hilcam
