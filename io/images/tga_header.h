#pragma once
// The head of a TGA picture, which has no mark to be known by: it is one whose fields agree (Truevision, "TGA File Format Specification",
// version 2.0, 1991, fields 1 to 5).

#include <cstdint>
#include <optional>

#include "io/images/picture_opening.h"

namespace hilcam {

struct TgaHeader {
    bool has_palette = false, is_grey = false, is_packed = false;  // packed: by run lengths
    std::uint64_t first_color = 0, colors = 0, color_bytes = 0;    // the palette has
    std::uint64_t width = 0, height = 0, pixel_bytes = 0;
    bool from_right = false;    // rows begin at the right
    bool interleaved = false;   // rows are not in their order
    std::uint64_t data_at = 0;  // the first byte of the pixels

    std::uint64_t pixels() const { return width * height; }
};

// Returns nothing for bytes whose fields do not agree. Any thread.
std::optional<TgaHeader> tga_header(const PictureOpening& h);

}  // namespace hilcam
