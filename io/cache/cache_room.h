#pragma once
// The files in a cache folder: their names, their size, and which go when there are too many.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

// Begins the ending of a file that is being written: "levels_123.bin.part-Ab3dE6".
inline constexpr const char* kUnfinished = ".part-";

struct CacheSize {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
};

struct CacheKind {
    const char* meaning;  // for people
    const char* prefix;   // names of its files begin with it
};
inline constexpr std::array kCacheKinds = {
    CacheKind{"tables of light", "transfer_"}, CacheKind{"levels of detail", "levels_"},
    CacheKind{"tables of air", "atmosphere_"}, CacheKind{"references", "reference_"},
    CacheKind{"generated meshes", "hilcam-"}};

// Returns the size of what hilcam has put into a cache folder: files of the names that it gives them, however old;
// prefix: only of that kind. Other files are somebody else's: they are neither counted nor removed.
CacheSize cache_size(const std::filesystem::path& folder, const std::string& prefix = "");
// Removes them but for meshes that somebody loads at the moment, and says what went. Whoever reads a table
// keeps what he has open. Throws InputError for a folder that cannot be trusted, DeviceError when a file
// cannot be removed.
CacheSize clear_cache(const std::filesystem::path& folder);
// Removes what was used longest ago until the folder has no more than `bound_bytes`, never the file `keep`; and what
// killed programs have left unfinished. Several programs may do this at once.
void make_room(const std::filesystem::path& folder, std::uint64_t bound_bytes, const std::string& keep);

}  // namespace hilcam
