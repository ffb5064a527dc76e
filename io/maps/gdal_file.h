#pragma once
// Opens a map with GDAL, within bounds: one of five formats, regular files of one folder, blocks of a
// readable size, no more values than the file has bytes for, and no network.

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

// Silences GDAL's messages while it exists, and keeps the last.
class QuietErrors {
  public:
    QuietErrors() {
        CPLPushErrorHandler(CPLQuietErrorHandler);
        CPLErrorReset();
    }
    ~QuietErrors() { CPLPopErrorHandler(); }
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;
    // Returns at most 200 bytes of the last message, without control characters.
    static std::string last();
};

// Starts GDAL, once per process; open_gdal_file() does so, too.
void start_gdal();
// Returns the folders of GDAL's and PROJ's own data.
std::vector<std::filesystem::path> gdal_folders();
// Throws InputError, one line that begins with `name`.
GdalFile open_gdal_file(const MapFiles& files, const std::string& name);

}  // namespace hilcam
