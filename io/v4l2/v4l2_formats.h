#pragma once
// The V4L2 pixel formats that hilcam can give, and what each makes of a frame.

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

// GREY and Y16 of a camera with a colour filter array carry its mosaic as it is. Throws InputError: a mosaic
// of a camera without one, YUYV of an odd width.
V4l2Pixels pixels_of(V4l2Format format, BayerPattern pattern, int width);
// The format of the same kind with the other bit depth: what the fault v4l2_format_flip opens with.
V4l2Format flipped(V4l2Format format);

// "Y16 ", "BA81"; bytes that are not printable become dots.
std::string fourcc_text(std::uint32_t fourcc);

}  // namespace hilcam
