// Any bytes are a shared memory whose frames lie in it, or refused in one line (tools/client/hilcam_shm.h).

#include "tools/client/hilcam_shm.h"

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::uint64_t> words(size / 8 + 1);
    if (size > 0) std::memcpy(words.data(), data, size);  // its places may not be null, even for none
    hilcam_shm ring;
    if (const char* problem = hilcam_shm_use(&ring, words.data(), size)) {
        HILCAM_CHECK(std::string_view(problem).find('\n') == std::string_view::npos);
        return 0;
    }
    const std::uint64_t newest = hilcam_shm_newest(&ring);
    std::uint64_t sum = 0;
    for (std::uint64_t number = newest; number + 4 > newest; --number) {
        hilcam_shm_frame frame;
        if (!hilcam_shm_get(&ring, number, &frame)) continue;
        for (std::uint32_t y = 0; y < frame.report.height_px; ++y)
            for (std::uint32_t x = 0; x < frame.report.width_px; ++x)
                sum += frame.pixels[y * (frame.report.row_bytes / 2) + x];
    }
    HILCAM_CHECK(sum <= 65535ULL * (size / 2) * 4);
    return 0;
}
