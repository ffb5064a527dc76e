#include "io/maps/gdal_file.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_frmts.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <vector>

#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDrivers[] = {"GTiff", "PDS", "PDS4", "ISIS3", "ENVI", nullptr};
// GDAL's own cache of blocks, in addition to the pages that are kept.
constexpr GIntBig kCacheBytes = 64 << 20;
// Largest block, because a block is read whole, whatever part is needed.
constexpr double kMaxBlock_bytes = 64 << 20;
// Number of a TIFF's blocks that are checked, spread over all of it.
constexpr int kBlocksLookedAt = 1 << 16;
// A file with more overviews than halvings of its size has useless ones.
constexpr int kMaxOverviews = 64;

// Replaces GDAL's own file systems, which access archives, programs and the network.
class NoFiles final : public VSIFilesystemHandler {
  public:
    VSIVirtualHandle* Open(const char*, const char*, bool, CSLConstList) override { return nullptr; }
    int Stat(const char*, VSIStatBufL*, int) override { return -1; }
};

void close_file_systems() {
    // GDAL drops a handler that another replaces and does not delete it, and one handler may serve several
    // prefixes. So they are kept until the process ends.
    static auto* const replaced = new std::vector<VSIFilesystemHandler*>;
    char** const prefixes = VSIGetFileSystemsPrefixes();
    for (char** prefix = prefixes; prefix && *prefix; ++prefix)
        // Formats use these two for parts of files and of memory. GDAL owns the handler from here on.
        if (const std::string_view own(*prefix);
            own.starts_with("/vsi") && own != "/vsimem/" && own != "/vsisubfile/") {
            replaced->push_back(VSIFileManager::GetHandler(*prefix));
            VSIFileManager::InstallHandler(*prefix, new NoFiles);
        }
    CSLDestroy(prefixes);
}

fs::path folder_of(const MapFiles& files) { return files.file.parent_path(); }

class Judge {
  public:
    Judge(GDALDataset& dataset, const MapFiles& files, const std::string& name)
        : dataset_(dataset), name_(name) {
        char** const list = dataset.GetFileList();
        for (char** one = list; one && *one; ++one) require_own(*one, folder_of(files));
        CSLDestroy(list);
    }

    // True when a block is too large, but the file can be read by rows: one strip without compression.
    bool wants_rows() const {
        return is_tiff() && !is_compressed() && block_bytes(*dataset_.GetRasterBand(1)) > kMaxBlock_bytes;
    }

    void require_sound() const {
        GDALRasterBand& band = *dataset_.GetRasterBand(1);
        require_sound(band);
        const int overviews = band.GetOverviewCount();
        if (overviews > kMaxOverviews)
            refuse("has " + std::to_string(overviews) + " overviews; accepted: at most " +
                   std::to_string(kMaxOverviews));
        for (int i = 0; i < overviews; ++i)
            if (GDALRasterBand* const overview = band.GetOverview(i)) require_sound(*overview);
    }

  private:
    GDALDataset& dataset_;
    const std::string& name_;
    double bytes_ = 0;  // size of the largest of its files, which has the values

    [[noreturn]] void refuse(const std::string& what) const { throw InputError(name_ + ": " + what); }

    void require_own(const fs::path& file, const fs::path& folder) {
        std::error_code error;
        if (file.parent_path() != folder || !fs::is_regular_file(file, error))
            refuse("consists of " + file.string() + ", too; accepted: regular files of its own folder");
        const std::uintmax_t size = fs::file_size(file, error);
        if (!error) bytes_ = std::max(bytes_, static_cast<double>(size));
    }
    bool is_tiff() const { return EQUAL(dataset_.GetDriver()->GetDescription(), "GTiff"); }
    std::string structure(const char* what) const {
        const char* const found = dataset_.GetMetadataItem(what, "IMAGE_STRUCTURE");
        return found ? found : "";
    }
    bool is_compressed() const { return !structure("COMPRESSION").empty(); }
    double value_bytes(GDALRasterBand& band) const {
        const char* const bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
        return bits ? std::atoi(bits) / 8.0 : GDALGetDataTypeSizeBytes(band.GetRasterDataType());
    }
    double block_bytes(GDALRasterBand& band) const {
        int columns = 0, rows = 0;
        band.GetBlockSize(&columns, &rows);
        const int together = EQUAL(structure("INTERLEAVE").c_str(), "PIXEL") ? dataset_.GetRasterCount() : 1;
        return 1.0 * columns * rows * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) * together;
    }

    void require_sound(GDALRasterBand& band) const {
        if (const double block = block_bytes(band); block > kMaxBlock_bytes)
            refuse("is stored in blocks of " + size_text(block) + "; accepted: of at most " +
                   size_text(kMaxBlock_bytes) + " (gdal_translate -co TILED=YES makes such)");
        if (!is_tiff() || (!is_compressed() && is_by_rows(band)))
            require_bytes(1.0 * band.GetXSize() * band.GetYSize() * value_bytes(band) *
                          dataset_.GetRasterCount());
        if (is_tiff()) require_blocks(band);
    }
    // With one strip read by rows, as wants_rows() requests, the blocks are not those of the file.
    static bool is_by_rows(GDALRasterBand& band) {
        int columns = 0, rows = 0;
        band.GetBlockSize(&columns, &rows);
        return rows == 1 && band.GetMetadataItem("BLOCK_OFFSET_0_1", "TIFF") == nullptr &&
               band.GetYSize() > 1 && band.GetMetadataItem("BLOCK_OFFSET_0_0", "TIFF") != nullptr;
    }
    static std::string size_text(double bytes) {
        return bytes < 1e6 ? std::to_string(static_cast<std::int64_t>(bytes)) + " bytes"
                           : std::to_string(static_cast<std::int64_t>(bytes / 1e6)) + " MB";
    }
    void require_bytes(double wanted) const {
        if (wanted > bytes_)
            refuse("has " + size_text(bytes_) + ", less than the " + size_text(wanted) +
                   " of values that it promises; accepted: a whole file");
    }

    // Each block has an entry in the file, and is inside the file unless it is left out.
    void require_blocks(GDALRasterBand& band) const {
        int columns = 0, rows = 0;
        band.GetBlockSize(&columns, &rows);
        const double across = std::ceil(1.0 * band.GetXSize() / columns),
                     down = std::ceil(1.0 * band.GetYSize() / rows);
        constexpr double kEntry_bytes = 4;
        if (!is_by_rows(band)) require_bytes(across * down * kEntry_bytes);
        const double step = std::max(1.0, across * down / kBlocksLookedAt);
        for (double i = 0; i < across * down; i += step) {
            const auto block = static_cast<std::int64_t>(i), x = block % static_cast<std::int64_t>(across),
                       y = block / static_cast<std::int64_t>(across);
            const std::string place = "_" + std::to_string(x) + "_" + std::to_string(y);
            const char* const offset = band.GetMetadataItem(("BLOCK_OFFSET" + place).c_str(), "TIFF");
            if (!offset) continue;
            const double begin = std::atof(offset);
            const char* const size = band.GetMetadataItem(("BLOCK_SIZE" + place).c_str(), "TIFF");
            if (begin + (size ? std::atof(size) : 0) > bytes_)
                refuse("ends after " + size_text(bytes_) + ", before its block in column " +
                       std::to_string(x) + ", row " + std::to_string(y) + "; accepted: a whole file");
        }
    }
};

GdalFile opened(const MapFiles& files, const std::string& name, bool by_rows) {
    CPLSetThreadLocalConfigOption("GDAL_ENABLE_TIFF_SPLIT", by_rows ? "YES" : "NO");
    CPLStringList beside;
    for (const std::string& one : files.beside) beside.AddString(one.c_str());
    GdalFile file(static_cast<GDALDataset*>(
        GDALOpenEx(files.file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, kDrivers, nullptr, beside.List())));
    if (file) return file;
    const std::string said = QuietErrors::last();
    throw InputError(name + ": is no map that can be read" + (said.empty() ? "" : " (" + said + ")") +
                     "; accepted: GeoTIFF, PDS3, PDS4, ISIS, ENVI, or a picture (.png) with bounds_deg");
}

}  // namespace

std::string QuietErrors::last() {
    std::string text = without_success(CPLGetLastErrorMsg());
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    if (constexpr std::size_t kMax = 200; text.size() > kMax) text.resize(kMax);
    return text;
}

void start_gdal() {
    static std::once_flag once;
    std::call_once(once, [] {
        // No network addresses, neither in a file's own text nor for PROJ's grids, and no files beside a map
        // except its header and its overviews.
        close_file_systems();
        CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");
        CPLSetConfigOption("GDAL_GEOREF_SOURCES", "INTERNAL");
        OSRSetPROJEnableNetwork(false);
        // Otherwise PROJ prints what is missing in a damaged file's projection.
        setenv("PROJ_DEBUG", "0", 0);
        GDALSetCacheMax64(kCacheBytes);
        GDALRegister_GTiff();
        GDALRegister_PDS();
        GDALRegister_PDS4();
        GDALRegister_ISIS3();
        GDALRegister_ENVI();
    });
}

std::vector<fs::path> gdal_folders() {
    start_gdal();
    std::vector<fs::path> out;
    char** const proj = OSRGetPROJSearchPaths();
    for (char** one = proj; one && *one; ++one) out.emplace_back(*one);
    CSLDestroy(proj);
    // The place of any of GDAL's files is the place of all.
    if (const char* const own = CPLFindFile("gdal", "gdalvrt.xsd"))
        out.push_back(fs::path(own).parent_path());
    return out;
}

GdalFile open_gdal_file(const MapFiles& files, const std::string& name) {
    start_gdal();
    GdalFile file = opened(files, name, false);
    if (file->GetRasterCount() < 1)
        throw InputError(name + ": has no values; accepted: a map with one channel or more");
    if (Judge(*file, files, name).wants_rows()) file = opened(files, name, true);
    Judge(*file, files, name).require_sound();
    return file;
}

}  // namespace hilcam
