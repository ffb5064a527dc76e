#pragma once
// Maps in the formats and projections of GDAL: GeoTIFF, PDS3, ISIS, ENVI. A part of hilcam-read-map (map_service.h), not of hilcam. Only
// files of this machine are opened, by these formats' drivers and no others: nothing is looked for in the network.

#include "io/maps/ground_map_file.h"
#include "io/maps/map_files.h"

namespace hilcam {

// See open_ground_map(). A map without overviews is read thinly where it is looked at from afar: make some of large ones
// (gdaladdo, or a Cloud-optimised GeoTIFF).
std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body,
                                               const MapFiles& files);
// The same of a map whose files are to be found.
std::unique_ptr<GroundRaster> open_gdal_raster(const GroundMapConfig& config, const MappedBody& body);

// Returns how messages about a map begin.
std::string map_name(const GroundMapConfig& config);

}  // namespace hilcam
