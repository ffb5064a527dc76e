#pragma once
// Reads maps in GDAL's formats and projections with a separate program, hilcam-read-map (read_map.cpp). GDAL
// and the hundred libraries that it brings stay outside hilcam, and a hostile map can harm only that process.

#include "io/maps/ground_map_file.h"

namespace hilcam {

// See open_ground_map(). Throws InputError also when the program is not installed, or when the file ends it.
// Each map has its own process, which ends with the map. When a map ends its reader later, everything read
// from then on is a hole and counts as a failed read.
std::unique_ptr<GroundRaster> open_map_by_helper(const GroundMapConfig& config, const MappedBody& body);
// Opens a map with another program.
std::unique_ptr<GroundRaster> open_map_by(const std::filesystem::path& program, const GroundMapConfig& config,
                                          const MappedBody& body);

// Returns which maps ended their reader during the work, and how; empty: none. Any thread.
std::string ended_map_readers();

}  // namespace hilcam
