#pragma once
// The files in a cache folder: their names and sizes, and which are removed when there are too many.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

// The beginning of the suffix of a file that is being written: "levels_123.bin.part-Ab3dE6".
inline constexpr const char* kUnfinished = ".part-";

struct CacheSize {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
};

struct CacheKind {
    const char* meaning;  // for users
    const char* prefix;   // common beginning of the names of its files
};
inline constexpr std::array kCacheKinds = {
    CacheKind{"tables of light", "transfer_"}, CacheKind{"levels of detail", "levels_"},
    CacheKind{"tables of air", "atmosphere_"}, CacheKind{"references", "reference_"},
    CacheKind{"generated meshes", "hilcam-"}};

// Returns the number and size of hilcam's files in a cache folder, of all ages, recognised by their names.
// Other files are neither counted nor removed. prefix: only files of that kind.
CacheSize cache_size(const std::filesystem::path& folder, const std::string& prefix = "");
// Removes these files, except meshes that some program is loading, and returns what was removed. A program
// that reads a table keeps it open. Throws InputError for a folder that cannot be trusted, DeviceError when a
// file cannot be removed.
CacheSize clear_cache(const std::filesystem::path& folder);
// Removes the files that were not used for longest until at most `bound_bytes` remain, but never the file
// `keep`; also removes unfinished files of killed programs. Several programs may do this at once.
void make_room(const std::filesystem::path& folder, std::uint64_t bound_bytes, const std::string& keep);

}  // namespace hilcam
