#pragma once
// Opens a map by GDAL, within bounds: one of five formats, regular files of one folder, blocks of a size that can be read, no more
// values than the file has bytes for, and nothing of the network.

#include <cpl_error.h>
#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/maps/map_files.h"

namespace hilcam {

struct CloseDataset {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using GdalFile = std::unique_ptr<GDALDataset, CloseDataset>;

// While there is one, nothing is printed; the last message is asked for.
class QuietErrors {
  public:
    QuietErrors() {
        CPLPushErrorHandler(CPLQuietErrorHandler);
        CPLErrorReset();
    }
    ~QuietErrors() { CPLPopErrorHandler(); }
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;
    // Returns at most 200 bytes of it, without control characters.
    static std::string last();
};

// Makes GDAL ready, once for the process; open_gdal_file() does so, too.
void start_gdal();
// Returns the folders in which GDAL and PROJ have their own data.
std::vector<std::filesystem::path> gdal_folders();
// Throws InputError, one line that begins with `name`.
GdalFile open_gdal_file(const MapFiles& files, const std::string& name);

}  // namespace hilcam
