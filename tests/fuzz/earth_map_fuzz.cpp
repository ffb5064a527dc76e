// Packed maps of the Earth: whatever the bytes, a map of finite values or an InputError.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "io/files/earth_map_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const hilcam::EarthMap map = hilcam::decode_earth_map({data, size}, "map");
        for (const float v : {0.0f, 0.3f, 1.0f})
            for (const float value : map.sample(0.7f, v, {0.01f, 0, 0, 0.02f}).value)
                if (!(value >= 0 && value <= 1.001f)) std::abort();
    } catch (const hilcam::InputError&) {
    }
    return 0;
}
