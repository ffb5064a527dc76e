#include "io/images/picture_codecs.h"
#include "io/images/stb_picture.h"
#include "io/images/tga_header.h"

namespace hilcam {
namespace {

// Checks run by run: a byte has the length minus one, and its upper bit says that the run is one pixel
// repeated (TGA specification, "Run-length encoded images"). Returns false when the file ends before the last
// pixel.
bool runs_are_whole(const PictureOpening& h, const TgaHeader& header) {
    std::uint64_t at = header.data_at, pixels = 0;
    while (pixels < header.pixels()) {
        if (at >= h.size()) return false;
        const std::uint64_t length = 1u + (h.byte(at) & 0x7F);
        at += 1 + header.pixel_bytes * (h.byte(at) & 0x80 ? 1 : length);
        pixels += length;
    }
    return at <= h.size();
}

bool is_whole(const PictureOpening& h, const TgaHeader& header) {
    if (header.data_at > h.size()) return false;
    if (header.is_packed) return runs_are_whole(h, header);
    return h.size() - header.data_at >= header.pixels() * header.pixel_bytes;
}

void turn_rows(Texture& texture) {
    const auto width = static_cast<std::ptrdiff_t>(texture.width);
    for (auto row = texture.texels.begin(); row != texture.texels.end(); row += width)
        std::reverse(row, row + width);
}

}  // namespace

Texture decode_tga(PictureBytes bytes) {
    const PictureOpening h(bytes);
    const auto header = tga_header(h);
    if (!header) throw undecodable("no head of a TGA");
    require_few_pixels(header->width, header->height);
    if (header->interleaved) throw undecodable("its rows are interleaved");
    if (header->has_palette && header->first_color != 0)
        throw undecodable("its palette begins at colour " + std::to_string(header->first_color));
    if (!is_whole(h, *header)) throw undecodable("the file ends too early");
    Texture texture = decode_by_stb(bytes);
    if (header->from_right) turn_rows(texture);
    return texture;
}

}  // namespace hilcam
