#include "io/images/tga_header.h"

namespace hilcam {
namespace {

bool is_depth(std::uint64_t bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

}  // namespace

std::optional<TgaHeader> tga_header(const PictureOpening& h) {
    constexpr std::uint64_t kHeader_bytes = 18;
    if (h.size() < kHeader_bytes) return {};
    const std::uint8_t map = h.byte(1), type = h.byte(2), depth = h.byte(16), about = h.byte(17);
    const std::uint8_t plain = type & 7;  // 1 palette, 2 colours, 3 grey; plus 8: run-length encoded
    if (map > 1 || (type != plain && type != plain + 8) || plain < 1 || plain > 3) return {};
    TgaHeader out;
    out.has_palette = plain == 1, out.is_grey = plain == 3, out.is_packed = type != plain;
    out.first_color = h.little(3, 2), out.colors = h.little(5, 2);
    const std::uint8_t color_bits = h.byte(7);
    if (out.has_palette != (map == 1)) return {};
    const bool is_small = depth == 8 || depth == 16;  // an index, or grey with or without an alpha channel
    if (plain == 2 ? !is_depth(depth) : !is_small) return {};
    if (out.has_palette && (!is_depth(color_bits) || out.colors == 0)) return {};
    out.color_bytes = map == 1 ? (color_bits + 7u) / 8 : 0;
    out.width = h.little(12, 2), out.height = h.little(14, 2), out.pixel_bytes = (depth + 7u) / 8;
    if (out.width == 0 || out.height == 0) return {};
    out.from_right = about & 0x10, out.interleaved = about & 0xC0;
    out.data_at = kHeader_bytes + h.byte(0) + out.colors * out.color_bytes;
    return out;
}

}  // namespace hilcam
