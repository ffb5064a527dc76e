// Any file is a map whose values are finite or holes, at places that are asked for, or refused in one line.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "io/maps/gdal_raster.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    // Beside it nothing lies that begins with its name.
    static const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                              ("hilcam_fuzz_ground_map_" + std::to_string(getpid())) / "map";
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    GroundMapConfig config;
    config.file = file;
    config.holes = MapHoles::kFill;
    const Figure moon{1737.4e3, 1737.4e3};
    try {
        std::vector<GroundMap> maps;
        // Here and not by the helper, so that its reader is what is fuzzed, and for speed.
        maps.push_back({open_gdal_raster(config, {"moon", moon})});
        GroundSurface surface(moon, std::move(maps), std::size_t{1} << 20);
        std::vector<Vec3d> places;
        for (int i = 0; i < 64; ++i) {
            const double z = 1 - (i + 0.5) / 32, r = std::sqrt(1 - z * z);
            places.push_back({r * std::cos(2.4 * i), r * std::sin(2.4 * i), z});
        }
        std::vector<double> heights_m(places.size());
        for (const double footprint_m : {0.0, 1e5}) {
            surface.find_heights(places, footprint_m, heights_m);
            for (const double height_m : heights_m) HILCAM_CHECK(std::isfinite(height_m));
        }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
