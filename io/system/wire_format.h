#pragma once
// A frame's numbers in the pixel formats that clients know: GigE Vision's (PFNC) and V4L2's.
//
// DN are right-aligned with `bits` significant bits. Formats of fewer bits take the upper ones (plain
// truncation, as cameras do), formats of more bits (Mono10 to Mono14, Bayer10, ...) multiply by a power of
// two so that full scale is full scale; Mono16, Bayer16 and V4L2's Y16 carry the DN in the most significant
// of 16 bits. Samples of more than 8 bits are little-endian. RGB8, RGB24 and YUYV of a colour filter array
// are interpolated (bilinear); of a camera without one all colours are equal. YUYV: luma of ITU-R BT.601,
// full range.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "render/vocabulary/image.h"

namespace hilcam {

struct CameraModel;

enum class WireFormat : std::uint8_t {
    kMono8,
    kMono10,
    kMono12,
    kMono14,
    kMono16,
    kMono10Packed,  // GigE Vision 1.2: two pixels in three bytes
    kMono12Packed,
    kMono10p,  // PFNC: a bit stream
    kMono12p,
    kBayer8,
    kBayer10,
    kBayer12,
    kBayer12Packed,
    kBayer16,
    kRgb8,
    kYuyv,
};

// The phase of a window's mosaic, which depends on where the window begins: "RGGB", "GRBG", "GBRG", "BGGR";
// empty: no filters.
using BayerPattern = std::string_view;
// Returns the pattern of a colour filter array's rows, "RG GB"; empty when it is none of the four.
std::string bayer_pattern_of(std::string_view rows);
// Returns the pattern of a camera's frames, as it is at their first pixel: the window may begin at any of the sensor's
// pixels, and black columns and rows come before it. Empty, too, where pixels of several colours are binned.
std::string bayer_pattern_of(const CameraModel& camera);
// The pattern as seen from an offset.
BayerPattern shifted(BayerPattern pattern, int offset_x, int offset_y);

// The Pixel Format Naming Convention's name and 32-bit code ("BayerRG12", 0x01100011); kYuyv is
// YUV422_8 (0x02100032).
std::string pfnc_name(WireFormat format, BayerPattern pattern);
std::uint32_t pfnc_code(WireFormat format, BayerPattern pattern);
// Formats that a GigE Vision camera offers, fewest bits first; and the one that keeps every bit of a DN.
std::span<const WireFormat> formats_of(BayerPattern pattern);
WireFormat native_format(int bits, BayerPattern pattern);

std::size_t wire_bytes(std::size_t pixels, WireFormat format);

struct Crop {
    int left = 0, top = 0, width = 0, height = 0;
};
// The crop of a frame into `out` (wire_bytes() long). `row` is scratch of at least 3 * crop.width + 8
// numbers. `pattern` is the crop's own. Any thread; no allocation.
void write_wire(const DnImage& frame, const Crop& crop, int bits, WireFormat format, BayerPattern pattern,
                std::span<std::uint16_t> row, std::span<std::uint8_t> out);
// Red, green and blue of each pixel of a mosaic, as write_wire() interpolates them, in all their bits. `row`:
// as there; out: three for each pixel. Any thread; no allocation.
void interpolate_colors(const DnImage& mosaic, BayerPattern pattern, std::span<std::uint16_t> row,
                        std::span<std::uint16_t> out);

}  // namespace hilcam
