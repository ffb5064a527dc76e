#include "emulator/campaign/run_lengths.h"

#include <numeric>

#include "render/vocabulary/check.h"

namespace hilcam {

RunLengths run_lengths_of(const IdImage& ids, const FrameRaster& raster, std::uint32_t id) {
    RunLengths runs = {0};
    bool inside = false;
    for (int x = 0; x < raster.width_px; ++x)
        for (int y = 0; y < raster.height_px; ++y) {
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(ids.width()) +
                                   static_cast<std::size_t>(x);
            if ((ids.data()[at] == id) != inside) inside = !inside, runs.push_back(0);
            ++runs.back();
        }
    return runs;
}

std::string run_length_text(const RunLengths& runs) {
    std::string text;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::int64_t value = runs[i];
        if (i > 2) value -= runs[i - 2];
        for (bool more = true; more;) {
            const auto bits = static_cast<int>(value & 0x1f);
            value >>= 5;
            more = (bits & 0x10) != 0 ? value != -1 : value != 0;
            text += static_cast<char>(48 + (more ? bits | 0x20 : bits));
        }
    }
    return text;
}

RunLengths parse_run_lengths(std::string_view text) {
    RunLengths runs;
    const auto refuse = [] {
        throw InputError("found run lengths that are none; accepted: COCO's, as text");
    };
    while (!text.empty()) {
        std::int64_t value = 0;
        for (int shift = 0;; shift += 5) {
            if (text.empty() || text.front() < 48 || text.front() > 111 || shift > 40) refuse();
            const int bits = text.front() - 48;
            text.remove_prefix(1);
            value |= std::int64_t{bits & 0x1f} << shift;
            if ((bits & 0x20) != 0) continue;
            if ((bits & 0x10) != 0) value -= std::int64_t{1} << (shift + 5);
            break;
        }
        if (runs.size() > 2) value += runs[runs.size() - 2];
        if (value < 0 || value > 0xffffffffll) refuse();
        runs.push_back(static_cast<std::uint32_t>(value));
    }
    return runs;
}

std::vector<std::uint8_t> mask_of(const RunLengths& runs, int width, int height) {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    if (std::accumulate(runs.begin(), runs.end(), std::uint64_t{0}) != std::uint64_t{columns} * rows)
        throw InputError("found run lengths of another size than the picture's");
    std::vector<std::uint8_t> mask(columns * rows);
    std::size_t at = 0;
    for (std::size_t i = 0; i < runs.size(); ++i)
        for (std::uint32_t n = 0; n < runs[i]; ++n, ++at)
            mask[at % rows * columns + at / rows] = i % 2 == 1 ? 255 : 0;
    return mask;
}

}  // namespace hilcam
