#pragma once
// Heights from a raw file: rows from north to south, columns from west to east, little-endian, nothing else
// in it (GDAL's ENVI format without its header, SRTM and LOLA rasters after gdal_translate -of ENVI). The
// file is mapped, so one larger than memory is read where it is looked at; it must not be cut short while the
// program runs, which would end it.

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

// Throws InputError when the file is absent or not as large as columns, rows and format make it. Heights that
// are not finite are 0 m. A file that is cut short while it is used ends the program (SIGBUS): do not.
std::unique_ptr<HeightMap> open_height_map(const HeightMapConfig& config);

}  // namespace hilcam
