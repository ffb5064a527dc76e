// Any file is a layer of the Earth whose texels can be read, tile by tile, or refused in one line.

#include <sys/mman.h>
#include <unistd.h>

#include <string_view>
#include <vector>

#include "io/maps/earth_layers.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const Fd file(memfd_create("layer", MFD_CLOEXEC));
    for (std::size_t done = 0; done < size;) {
        const ssize_t count = write(file.get(), data + done, size - done);
        HILCAM_CHECK(count > 0);
        done += static_cast<std::size_t>(count);
    }
    EarthMap::Level level{32, 16, {}};
    level.texels.assign(512, EarthMap::Texel{128, 128, 128, 128});
    const EarthMap map(EarthMap::halves(std::move(level)));
    for (const auto kind : {EarthLayerConfig::Kind::kLand, EarthLayerConfig::Kind::kWater}) {
        EarthLayerConfig config;
        config.file = "/proc/self/fd/" + std::to_string(file.get());
        config.kind = kind;
        try {
            const LayeredEarth earth = with_layers(map, {config});
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
