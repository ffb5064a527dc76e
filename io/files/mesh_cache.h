#pragma once
// Meshes that a generator program makes at first use, kept in a cache folder under a name that tells its
// arguments.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hilcam {

// The folder of $HILCAM_CACHE, else $XDG_CACHE_HOME/hilcam, else ~/.cache/hilcam.
std::filesystem::path cache_folder();

// The size of what hilcam has put into a cache folder: files of the names that it gives them, however old.
// Other files are somebody else's: they are neither counted nor removed.
struct CacheSize {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
};
CacheSize cache_size(const std::filesystem::path& folder = cache_folder());
// Removes them and says what went. Whoever reads one at the moment keeps what he has open. Throws DeviceError
// when one cannot be removed.
CacheSize clear_cache(const std::filesystem::path& folder = cache_folder());

// The cached file of `program` run with `arguments` ("--triangles", "3000000", ...) and "--out FILE", made
// now if it is not there yet. The program is the one of that name beside this executable; no shell is
// involved. Throws InputError when it is missing or refuses its arguments, DeviceError when it fails or the
// folder cannot be written.
std::filesystem::path generated_mesh(const std::string& program, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder = cache_folder());

}  // namespace hilcam
