#pragma once
// TIFFs as an attacker writes them: a directory of tags that promises anything, and some bytes.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hilcam {

struct TiffTags {
    std::uint32_t columns = 8, rows = 8;
    std::uint16_t bits = 16, compression = 1;  // 1: none, 5: LZW, 8: deflate
    std::uint32_t rows_per_strip = 8;
    std::uint32_t tile_columns = 0, tile_rows = 0;  // 0: strips
    std::string values = std::string(128, '\0');    // those of the only strip or tile
    std::uint32_t said_bytes = 0;                   // how many there are by the tag; 0: as many as there are
};

inline std::string tiff(const TiffTags& t) {
    std::vector<std::pair<std::uint16_t, std::uint32_t>> tags{
        {256, t.columns}, {257, t.rows}, {258, t.bits}, {259, t.compression}, {262, 1}};
    const std::size_t count = t.tile_columns > 0 ? 10 : 9;
    const auto data_at = static_cast<std::uint32_t>(8 + 2 + 12 * count + 4);
    const auto bytes = t.said_bytes > 0 ? t.said_bytes : static_cast<std::uint32_t>(t.values.size());
    if (t.tile_columns > 0)
        tags.insert(tags.end(),
                    {{277, 1}, {322, t.tile_columns}, {323, t.tile_rows}, {324, data_at}, {325, bytes}});
    else
        tags.insert(tags.end(), {{273, data_at}, {277, 1}, {278, t.rows_per_strip}, {279, bytes}});
    std::string out("II*\0\10\0\0\0", 8);
    const auto put = [&](std::uint32_t value, int size) {
        for (int i = 0; i < size; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
    };
    put(static_cast<std::uint32_t>(count), 2);
    for (const auto& [tag, value] : tags) {
        const bool is_short = tag == 258 || tag == 259 || tag == 262 || tag == 277;
        put(tag, 2), put(is_short ? 3 : 4, 2), put(1, 4), put(value, 4);
    }
    put(0, 4);
    return out + t.values;
}

}  // namespace hilcam
