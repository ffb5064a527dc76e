#include "io/images/picture_size.h"

#include <algorithm>
#include <string_view>

#include "io/images/picture_opening.h"
#include "io/images/pnm_header.h"
#include "io/images/tga_header.h"

namespace hilcam {
namespace {

// PNG specification (W3C, third edition), 5.2 and 11.2.1: the signature, then the chunk IHDR.
PictureSize png_size(const PictureOpening& h) { return {h.big(16, 4), h.big(20, 4)}; }

// BITMAPCOREHEADER of 12 bytes has 16-bit sizes, BITMAPINFOHEADER and later ones signed 32-bit sizes, where a
// negative height means rows from the top (Microsoft, "Bitmap Header Types").
PictureSize bmp_size(const PictureOpening& h) {
    if (h.little(14, 4) == 12) return {h.little(18, 2), h.little(20, 2)};
    const auto height = static_cast<std::int32_t>(h.little(22, 4));
    return {h.little(18, 4), static_cast<std::uint64_t>(height < 0 ? -std::int64_t{height} : height)};
}

// RFC 9649, 2.5 to 2.7: the first chunk is VP8X with the canvas, or the picture itself.
PictureSize webp_size(const PictureOpening& h) {
    if (h.has(12, "VP8X")) return {h.little(24, 3) + 1, h.little(27, 3) + 1};
    if (h.has(12, "VP8L")) {
        const std::uint64_t bits = h.little(21, 4);
        return {(bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1};
    }
    // RFC 6386, 9.1: 14 bits each behind the start code.
    return {h.little(26, 2) & 0x3FFF, h.little(28, 2) & 0x3FFF};
}

// ITU-T T.81, B.1 and B.2.2: marker segments up to the first frame header (SOF0 to SOF15 but DHT, JPG, DAC).
PictureSize jpeg_size(const PictureOpening& h) {
    std::uint64_t at = 2;
    while (at + 9 < h.size()) {
        if (h.byte(at) != 0xFF) return {};
        const std::uint8_t marker = h.byte(at + 1);
        if (marker == 0xFF) {  // fill bytes
            ++at;
            continue;
        }
        if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC)
            return {h.big(at + 7, 2), h.big(at + 5, 2)};
        at += 2 + h.big(at + 2, 2);
    }
    return {};
}

// TIFF 6.0 (Adobe, 1992), section 2, and BigTIFF: the first directory's ImageWidth (256) and ImageLength
// (257).
PictureSize tiff_size(const PictureOpening& h) {
    const bool little = h.byte(0) == 'I';
    const auto number = [&](std::uint64_t at, unsigned bytes) {
        return little ? h.little(at, bytes) : h.big(at, bytes);
    };
    const bool large = number(2, 2) == 43;
    const std::uint64_t directory = large ? number(8, 8) : number(4, 4);
    if (directory >= h.size()) return {};
    const std::uint64_t entries =
        std::min<std::uint64_t>(large ? number(directory, 8) : number(directory, 2), 65535);
    PictureSize out;
    for (std::uint64_t i = 0; i < entries; ++i) {
        const std::uint64_t at = directory + (large ? 8 + 20 * i : 2 + 12 * i);
        const std::uint64_t tag = number(at, 2), type = number(at + 2, 2), value = at + (large ? 12 : 8);
        if (tag != 256 && tag != 257) continue;
        (tag == 256 ? out.width : out.height) = number(value, type == 3 ? 2 : type == 16 ? 8 : 4);
    }
    return out;
}

}  // namespace

std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes) {
    const PictureOpening h(bytes);
    PictureSize size;
    if (h.has(0, "\x89PNG\r\n\x1a\n")) size = png_size(h), size.kind = PictureKind::kPng;
    if (h.has(0, "BM")) size = bmp_size(h), size.kind = PictureKind::kBmp;
    if (h.has(0, "RIFF") && h.has(8, "WEBP")) size = webp_size(h), size.kind = PictureKind::kWebp;
    if (h.has(0, "\xFF\xD8")) size = jpeg_size(h), size.kind = PictureKind::kJpeg;
    if (h.has(0, "II*") || h.has(0, "II+") || h.has(0, std::string_view("MM\0*", 4)) ||
        h.has(0, std::string_view("MM\0+", 4)))
        size = tiff_size(h), size.kind = PictureKind::kTiff;
    if (const auto pnm = pnm_header(bytes)) size = {pnm->width, pnm->height, PictureKind::kPnm};
    if (size.width == 0 && size.height == 0)
        if (const auto tga = tga_header(h)) size = {tga->width, tga->height, PictureKind::kTga};
    if (size.width == 0 || size.height == 0) return {};
    return size;
}

}  // namespace hilcam
