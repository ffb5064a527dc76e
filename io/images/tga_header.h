#pragma once
// The header of a TGA picture. The format has no signature, so a header counts when its fields agree
// (Truevision, "TGA File Format Specification", version 2.0, 1991, fields 1 to 5).

#include <cstdint>
#include <optional>

#include "io/images/picture_opening.h"

namespace hilcam {

struct TgaHeader {
    bool has_palette = false, is_grey = false, is_packed = false;  // packed: run-length encoded
    std::uint64_t first_color = 0, colors = 0, color_bytes = 0;    // the palette's
    std::uint64_t width = 0, height = 0, pixel_bytes = 0;
    bool from_right = false;    // rows begin at the right
    bool interleaved = false;   // rows are not in order
    std::uint64_t data_at = 0;  // offset of the pixels

    std::uint64_t pixels() const { return width * height; }
};

// Returns nothing when the fields do not agree. Any thread.
std::optional<TgaHeader> tga_header(const PictureOpening& h);

}  // namespace hilcam
