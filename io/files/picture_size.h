#pragma once
// How large a picture is, from its header alone: before anything is decoded. PNG, JPEG, TIFF, BMP, WebP, and
// Netpbm's kinds.

#include <cstdint>
#include <optional>
#include <span>

namespace hilcam {

struct PictureSize {
    std::uint64_t width = 0, height = 0;
};

// Nothing when the bytes are none of these kinds or have no such header. A size of 0 is nothing, too.
std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes);

}  // namespace hilcam
