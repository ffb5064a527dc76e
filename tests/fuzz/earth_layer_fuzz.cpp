// Any file is a layer of the Earth whose texels can be read, tile by tile, or refused in one line.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "io/maps/earth_layers.h"
#include "io/maps/gdal_raster.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    // Beside it nothing lies that begins with its name.
    static const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                              ("hilcam_fuzz_earth_layer_" + std::to_string(getpid())) / "map";
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    EarthMap::Level level{32, 16, {}};
    level.texels.assign(512, EarthMap::Texel{128, 128, 128, 128});
    const EarthMap map(EarthMap::halves(std::move(level)));
    for (const auto kind : {EarthLayerConfig::Kind::kLand, EarthLayerConfig::Kind::kWater}) {
        EarthLayerConfig config;
        config.file = file;
        config.kind = kind;
        try {
            // Here and not by the helper, so that its reader is what is fuzzed, and for speed.
            std::vector<EarthLayerRaster> layers;
            layers.emplace_back(config, open_gdal_raster(map_of_layer(config), earth_body()));
            const LayeredEarth earth = with_layers(map, std::move(layers));
            if (!earth.detail) continue;
            std::vector<EarthMap::Texel> texels(EarthDetail::kTexels);
            const EarthDetail::Shape& shape = earth.detail->shape();
            for (int at = 0; at < shape.levels; ++at) {
                earth.detail->read({at, 0, 0}, earth.map, texels);
                earth.detail->read({at, shape.tiles_across(at) - 1, shape.tiles_down(at) - 1}, earth.map,
                                   texels);
            }
        } catch (const InputError& error) {
            HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
        }
    }
    return 0;
}
