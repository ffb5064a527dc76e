#pragma once
// Maps that are PNG pictures in longitude and latitude; held in memory whole.

#include "io/maps/ground_map_file.h"

namespace hilcam {

// True for names that end in .png.
bool is_picture(const std::filesystem::path& file);
// Heights have one channel of numbers, albedo has one, or three of 8 bits. See open_ground_map().
std::unique_ptr<GroundRaster> open_picture_raster(const GroundMapConfig& config, const MappedBody& body);

}  // namespace hilcam
