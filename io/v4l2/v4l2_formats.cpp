#include "io/v4l2/v4l2_formats.h"

#include <linux/videodev2.h>

#include <array>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::array<BayerPattern, 4> kV4l2Patterns = {"RGGB", "GRBG", "GBRG", "BGGR"};
// V4L2 has a code for each phase.
using Phases = std::array<std::uint32_t, 4>;
constexpr Phases kBayer8 = {V4L2_PIX_FMT_SRGGB8, V4L2_PIX_FMT_SGRBG8, V4L2_PIX_FMT_SGBRG8,
                            V4L2_PIX_FMT_SBGGR8};
constexpr Phases kBayer10 = {V4L2_PIX_FMT_SRGGB10, V4L2_PIX_FMT_SGRBG10, V4L2_PIX_FMT_SGBRG10,
                             V4L2_PIX_FMT_SBGGR10};
constexpr Phases kBayer12 = {V4L2_PIX_FMT_SRGGB12, V4L2_PIX_FMT_SGRBG12, V4L2_PIX_FMT_SGBRG12,
                             V4L2_PIX_FMT_SBGGR12};

std::uint32_t phase_of(const Phases& codes, BayerPattern pattern) {
    for (std::size_t i = 0; i < kV4l2Patterns.size(); ++i)
        if (kV4l2Patterns[i] == pattern) return codes[i];
    throw InputError("format: found a Bayer format, but the camera has " +
                     (pattern.empty() ? std::string("no colour filters")
                                      : "the colour filters '" + std::string(pattern) + "'") +
                     "; accepted: GREY, Y16, YUYV, RGB24");
}

}  // namespace

V4l2Pixels pixels_of(V4l2Format format, BayerPattern pattern, int width) {
    switch (format) {
        case V4l2Format::kGrey:
            return {V4L2_PIX_FMT_GREY, WireFormat::kMono8, 1};
        case V4l2Format::kY16:
            return {V4L2_PIX_FMT_Y16, WireFormat::kMono16, 2};
        case V4l2Format::kBayer8:
            return {phase_of(kBayer8, pattern), WireFormat::kBayer8, 1};
        case V4l2Format::kBayer10:
            return {phase_of(kBayer10, pattern), WireFormat::kBayer10, 2};
        case V4l2Format::kBayer12:
            return {phase_of(kBayer12, pattern), WireFormat::kBayer12, 2};
        case V4l2Format::kYuyv:
            if (width % 2 != 0)
                throw InputError("format: YUYV shares colour between two pixels; the camera's width is " +
                                 std::to_string(width) + ", accepted: an even one");
            return {V4L2_PIX_FMT_YUYV, WireFormat::kYuyv, 2};
        case V4l2Format::kRgb24:
            return {V4L2_PIX_FMT_RGB24, WireFormat::kRgb8, 3};
    }
    throw InputError("no such V4L2 format");
}

V4l2Format flipped(V4l2Format format) {
    switch (format) {
        case V4l2Format::kGrey:
        case V4l2Format::kYuyv:
        case V4l2Format::kRgb24:
        case V4l2Format::kBayer8:  // Y16 carries its mosaic: old modules have no Bayer above 8 bits
            return V4l2Format::kY16;
        case V4l2Format::kBayer10:
        case V4l2Format::kBayer12:
            return V4l2Format::kBayer8;
        case V4l2Format::kY16:
            break;
    }
    return V4l2Format::kGrey;
}

std::string fourcc_text(std::uint32_t fourcc) {
    std::string text;
    for (int i = 0; i < 4; ++i) {
        const auto letter = static_cast<char>(fourcc >> (8 * i) & 0x7F);
        text += letter >= 0x20 && letter < 0x7F ? letter : '.';
    }
    return text;
}

}  // namespace hilcam
