#pragma once
// Heights from a raw file: rows from north to south, columns from west to east, little-endian, without a
// header (GDAL's ENVI format without its header; SRTM and LOLA rasters after gdal_translate -of ENVI). The
// file is mapped into memory, so it may be larger than memory.

#include <filesystem>
#include <memory>

#include "render/ground/height_map.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

enum class HeightFormat { kInt16, kFloat32 };

struct HeightMapConfig {
    std::filesystem::path file;
    std::int64_t columns = 2, rows = 2;
    HeightFormat format = HeightFormat::kInt16;
    double spacing_m = 1;
    double scale = 1;     // metres per unit of the file
    double offset_m = 0;  // height of the value 0
};
Fields fields(HeightMapConfig& config);

// Throws InputError when the file is missing or its size does not match columns, rows and format. Heights
// that are not finite read as 0 m. Do not truncate the file while the program runs: that ends it with SIGBUS.
std::unique_ptr<HeightMap> open_height_map(const HeightMapConfig& config);

}  // namespace hilcam
