#pragma once
// Finds what kind a picture is and how large, from its header alone: before anything is decoded.

#include <cstdint>
#include <optional>
#include <span>

namespace hilcam {

// A picture of 16384 x 16384 has so many, a map of 21600 x 10800 fewer: 0.8 GB of colours.
inline constexpr std::uint64_t kMaxPicturePixels = std::uint64_t{1} << 28;

enum class PictureKind { kPng, kJpeg, kTiff, kBmp, kWebp, kPnm, kTga };

struct PictureSize {
    std::uint64_t width = 0, height = 0;
    PictureKind kind = PictureKind::kPng;
};

// Nothing when the bytes are none of these kinds or have no such header. A size of 0 is nothing, too.
std::optional<PictureSize> picture_size(std::span<const std::uint8_t> bytes);

}  // namespace hilcam
