#pragma once
// Finds the format and the size of a picture from its header, before anything is decoded.

#include <cstdint>
#include <optional>
#include <span>

namespace hilcam {

// The pixels of a picture of 16384 x 16384, 0.8 GB of colours. A map of 21600 x 10800 has fewer.
inline constexpr std::uint64_t kMaxPicturePixels = std::uint64_t{1} << 28;

enum class PictureKind { kPng, kJpeg, kTiff, kBmp, kWebp, kPnm, kTga };

struct PictureSize {
    std::uint64_t width = 0, height = 0;
    PictureKind kind = PictureKind::kPng;
};

// Returns nothing when the bytes are of none of these kinds, have no such header, or say a size of 0.
std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes);

}  // namespace hilcam
