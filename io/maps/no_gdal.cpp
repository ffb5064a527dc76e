#include "io/maps/gdal_raster.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody&) {
    throw InputError(
        config.file.string() +
        ": this hilcam was built without GDAL (-DHILCAM_GDAL=OFF); accepted: pictures (.png) with "
        "bounds_deg, or a build with it");
}

}  // namespace hilcam
