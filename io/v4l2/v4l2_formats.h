#pragma once
// The V4L2 pixel formats that hilcam can write, and how each represents a frame.

#include <cstdint>
#include <string>
#include <string_view>

#include "io/system/wire_format.h"

namespace hilcam {

enum class V4l2Format : std::uint8_t { kGrey, kY16, kBayer8, kBayer10, kBayer12, kYuyv, kRgb24 };

struct V4l2Pixels {
    std::uint32_t fourcc = 0;
    WireFormat wire = WireFormat::kMono16;
    std::size_t bytes_per_pixel = 2;
};

// Returns the pixels of a format. GREY and Y16 carry the raw mosaic of a camera with a colour filter array.
// Throws InputError for a Bayer format of a monochrome camera, and for YUYV with an odd width.
V4l2Pixels pixels_of(V4l2Format format, BayerPattern pattern, int width);
// Returns the format of the same kind with the other bit depth, which the fault v4l2_format_flip uses.
V4l2Format flipped(V4l2Format format);

// Returns a fourcc as text, "Y16 " or "BA81"; bytes that are not printable become dots.
std::string fourcc_text(std::uint32_t fourcc);

}  // namespace hilcam
