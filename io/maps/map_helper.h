#pragma once
// Maps in the formats and projections of GDAL, read by a program of their own, hilcam-read-map (read_map.cpp): GDAL and the hundred
// libraries that it brings are no part of hilcam, and what a hostile map does to them, it does to that process.

#include "io/maps/ground_map_file.h"

namespace hilcam {

// See open_ground_map(). InputError also says where the program is not installed, and where a file ends it. Each map has a process of
// its own, which ends with the map. When a map breaks its reader later, what is asked for from then on is a hole, and counts as a
// failed read.
std::unique_ptr<GroundRaster> open_map_by_helper(const GroundMapConfig& config, const MappedBody& body);
// The same by a program of another path.
std::unique_ptr<GroundRaster> open_map_by(const std::filesystem::path& program, const GroundMapConfig& config,
                                          const MappedBody& body);

// Says which maps have ended their reader in the middle of the work, and how; empty: none. Any thread.
std::string ended_map_readers();

}  // namespace hilcam
