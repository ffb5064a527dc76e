// Any file is a map whose values are finite or holes, at places that are asked for, or refused in one line.

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "io/maps/ground_map_file.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const Fd file(memfd_create("map", MFD_CLOEXEC));
    for (std::size_t done = 0; done < size;) {
        const ssize_t count = write(file.get(), data + done, size - done);
        HILCAM_CHECK(count > 0);
        done += static_cast<std::size_t>(count);
    }
    GroundMapConfig config;
    config.file = "/proc/self/fd/" + std::to_string(file.get());
    config.holes = MapHoles::kFill;
    const Figure moon{1737.4e3, 1737.4e3};
    try {
        std::vector<GroundMap> maps;
        maps.push_back(open_ground_map(config, {"moon", moon}));
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
