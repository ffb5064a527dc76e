#pragma once
// A frame's DN in the pixel formats of clients: GigE Vision's (PFNC) and V4L2's.
//
// DN are right-aligned with `bits` significant bits. A format of fewer bits takes the upper ones (truncation,
// as in cameras). A format of more bits (Mono10 to Mono14, Bayer10, ...) multiplies by a power of two, so
// that full scale stays full scale. Mono16, Bayer16 and V4L2's Y16 carry the DN in the most significant of 16
// bits. Samples of more than 8 bits are little-endian. RGB8, RGB24 and YUYV from a colour filter array are
// interpolated bilinearly; from a monochrome camera all colours are equal. YUYV has the luma of ITU-R BT.601,
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

// The phase of a window's colour filter array, which depends on where the window begins: "RGGB", "GRBG",
// "GBRG", "BGGR"; empty: monochrome.
using BayerPattern = std::string_view;
// Returns the pattern of a colour filter array's rows, "RG GB"; empty when it is none of the four.
std::string bayer_pattern_of(std::string_view rows);
// Returns the pattern at the first pixel of a camera's frames: a window may begin at any pixel of the sensor,
// after black columns and rows. Empty for a monochrome camera, and where binning mixes colours.
std::string bayer_pattern_of(const CameraModel& camera);
// Returns the pattern as seen from an offset.
BayerPattern shifted(BayerPattern pattern, int offset_x, int offset_y);

// Returns the name and the 32-bit code of the Pixel Format Naming Convention ("BayerRG12", 0x01100011); kYuyv
// is YUV422_8 (0x02100032).
std::string pfnc_name(WireFormat format, BayerPattern pattern);
std::uint32_t pfnc_code(WireFormat format, BayerPattern pattern);
// formats_of() returns the formats that a GigE Vision camera offers, fewest bits first; native_format()
// returns the one that keeps every bit of a DN.
std::span<const WireFormat> formats_of(BayerPattern pattern);
WireFormat native_format(int bits, BayerPattern pattern);

std::size_t wire_bytes(std::size_t pixels, WireFormat format);

struct Crop {
    int left = 0, top = 0, width = 0, height = 0;
};
// Writes the crop of a frame to `out`, of wire_bytes() bytes. row: scratch of at least 3 * crop.width + 8
// numbers. pattern: at the crop's first pixel. Any thread; no allocation.
void write_wire(const DnImage& frame, const Crop& crop, int bits, WireFormat format, BayerPattern pattern,
                std::span<std::uint16_t> row, std::span<std::uint8_t> out);
// Interpolates red, green and blue at each pixel of a mosaic, as write_wire() does, with all bits. row:
// scratch as there. out: three numbers per pixel. Any thread; no allocation.
void interpolate_colors(const DnImage& mosaic, BayerPattern pattern, std::span<std::uint16_t> row,
                        std::span<std::uint16_t> out);

}  // namespace hilcam
