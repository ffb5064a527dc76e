#pragma once
// Maps in GDAL's formats and projections: GeoTIFF, PDS3, ISIS, ENVI. A part of hilcam-read-map
// (map_service.h), not of hilcam. Only local files are opened, and only by the drivers of these formats; the
// network is not used.

#include "io/maps/ground_map_file.h"
#include "io/maps/map_files.h"

namespace hilcam {

// See open_ground_map(). A map without overviews is subsampled where it is seen from afar: add overviews to
// large ones (gdaladdo, or a Cloud-optimised GeoTIFF).
std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body,
                                               const MapFiles& files);
// Opens a map after finding its files.
std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body);

// Returns the beginning of messages about a map.
std::string map_name(const GroundMapConfig& config);

}  // namespace hilcam
