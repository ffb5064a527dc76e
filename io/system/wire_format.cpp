#include "io/system/wire_format.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "render/vocabulary/check.h"
#include "sensor/camera_model.h"
#include "sensor/packing.h"

namespace hilcam {
namespace {

// The codes of PFNC have the patterns in this order.
constexpr std::array<BayerPattern, 4> kPatterns = {"GRBG", "RGGB", "GBRG", "BGGR"};

struct Format {
    WireFormat format;
    std::string_view name;  // Bayer: the part after "BayerRG"
    std::uint32_t code;     // Bayer: of GRBG (PFNC 2.4; the "Packed" ones: GigE Vision 1.2)
    int bits;               // bits of a sample
    bool mosaic = false;
};
constexpr std::array<Format, 16> kFormats = {{
    {WireFormat::kMono8, "Mono8", 0x01080001, 8},
    {WireFormat::kMono10, "Mono10", 0x01100003, 10},
    {WireFormat::kMono12, "Mono12", 0x01100005, 12},
    {WireFormat::kMono14, "Mono14", 0x01100025, 14},
    {WireFormat::kMono16, "Mono16", 0x01100007, 16},
    {WireFormat::kMono10Packed, "Mono10Packed", 0x010C0004, 10},
    {WireFormat::kMono12Packed, "Mono12Packed", 0x010C0006, 12},
    {WireFormat::kMono10p, "Mono10p", 0x010A0046, 10},
    {WireFormat::kMono12p, "Mono12p", 0x010C0047, 12},
    {WireFormat::kBayer8, "8", 0x01080008, 8, true},
    {WireFormat::kBayer10, "10", 0x0110000C, 10, true},
    {WireFormat::kBayer12, "12", 0x01100010, 12, true},
    {WireFormat::kBayer12Packed, "12Packed", 0x010C002A, 12, true},
    {WireFormat::kBayer16, "16", 0x0110002E, 16, true},
    {WireFormat::kRgb8, "RGB8", 0x02180014, 8},
    {WireFormat::kYuyv, "YUV422_8", 0x02100032, 8},
}};

const Format& format_of(WireFormat format) {
    const Format& f = kFormats[static_cast<std::size_t>(format)];
    HILCAM_DCHECK(f.format == format);
    return f;
}

std::uint32_t place_of(BayerPattern pattern) {
    const auto* const at = std::find(kPatterns.begin(), kPatterns.end(), pattern);
    HILCAM_CHECK(at != kPatterns.end());
    return static_cast<std::uint32_t>(at - kPatterns.begin());
}

// Shifts a DN's bits to a sample's: upwards by a power of two, downwards by truncation.
struct Shift {
    int up = 0, down = 0;
    Shift(int from_bits, int to_bits)
        : up(std::max(0, to_bits - from_bits)), down(std::max(0, from_bits - to_bits)) {}
    std::uint16_t operator()(unsigned dn) const { return static_cast<std::uint16_t>(dn << up >> down); }
};

struct PixelSource {
    const DnImage& frame;
    const Crop& crop;
    Shift shift;

    const std::uint16_t* row(int y) const { return frame.row(crop.top + y).data() + crop.left; }
    std::size_t width() const { return static_cast<std::size_t>(crop.width); }
};

// --- one sample a pixel

void write_bytes(const PixelSource& s, std::uint8_t* out) {
    const std::size_t width = s.width();
    const Shift shift = s.shift;
    for (int y = 0; y < s.crop.height; ++y, out += width) {
        const std::uint16_t* const in = s.row(y);
        if (shift.up == 0)
            for (std::size_t x = 0; x < width; ++x) out[x] = static_cast<std::uint8_t>(in[x] >> shift.down);
        else
            for (std::size_t x = 0; x < width; ++x) out[x] = static_cast<std::uint8_t>(in[x] << shift.up);
    }
}

// The wire is little-endian, as are the machines that Embree runs on.
void write_words(const PixelSource& s, std::uint16_t* row, std::uint8_t* out) {
    const std::size_t width = s.width();
    const Shift shift = s.shift;
    const bool as_it_is = shift.up == 0 && shift.down == 0;
    for (int y = 0; y < s.crop.height; ++y, out += 2 * width) {
        const std::uint16_t* const in = s.row(y);
        if (!as_it_is)
            for (std::size_t x = 0; x < width; ++x) row[x] = shift(in[x]);
        std::memcpy(out, as_it_is ? in : row, 2 * width);
    }
}

// Pixels continue without a gap from row to row; those that do not fill a group of bytes wait for the next
// row.
void write_packed(const PixelSource& s, const PixelLayout& layout, std::uint16_t* row,
                  std::span<std::uint8_t> out) {
    const std::size_t group = layout.packing == Packing::kPfnc && layout.bits == 10 ? 4 : 2;
    std::size_t waiting = 0;
    for (int y = 0; y < s.crop.height; ++y) {
        const std::uint16_t* const in = s.row(y);
        for (std::size_t x = 0; x < s.width(); ++x) row[waiting + x] = s.shift(in[x]);
        const std::size_t have = waiting + s.width();
        const std::size_t now = y + 1 == s.crop.height ? have : have / group * group;
        const std::size_t bytes = packed_bytes(now, layout);
        pack({row, now}, layout, out.first(bytes));
        out = out.subspan(bytes);
        waiting = have - now;
        std::copy_n(row + now, waiting, row);
    }
}

// --- colours

constexpr int mirrored(int at, int size) {
    if (size == 1) return 0;
    return at < 0 ? -at : at >= size ? 2 * size - 2 - at : at;
}

// Three rows of a mosaic around the row in work, with a pixel more on either side. Beyond the frame's edges
// the mosaic is mirrored, which keeps its phase. At a crop's edges the neighbours are real pixels, so its
// colours are the whole frame's.
class Neighbours {
  public:
    Neighbours(const PixelSource& source, std::span<std::uint16_t> scratch) : s_(source) {
        const std::size_t length = source.width() + 2;
        for (std::size_t i = 0; i < 3; ++i) rows_[i] = scratch.data() + i * length;
    }
    void go_to(int y) {
        const int width = s_.frame.width(), left = s_.crop.left, right = left + s_.crop.width;
        for (int i = 0; i < 3; ++i) {
            const auto in = s_.frame.row(mirrored(s_.crop.top + y + i - 1, s_.frame.height()));
            std::uint16_t* const row = rows_[static_cast<std::size_t>(i)];
            row[0] = in[static_cast<std::size_t>(mirrored(left - 1, width))];
            std::copy_n(in.data() + left, s_.crop.width, row + 1);
            row[s_.crop.width + 1] = in[static_cast<std::size_t>(mirrored(right, width))];
        }
    }
    // Returns the pixel to the left of x. i: 0 for the row above, 1 for x's own, 2 for the row below.
    const std::uint16_t* before(std::size_t x, std::size_t i) const { return rows_[i] + x; }

  private:
    const PixelSource& s_;
    std::array<std::uint16_t*, 3> rows_{};
};

// Colours of some pixels of a row, 8 bits each.
struct Block {
    static constexpr std::size_t kPixels = 64;  // even: blocks begin with the same pixel of a pair
    std::array<std::uint16_t, kPixels> r, g, b;
    std::size_t pixels = 0;
};

// Interpolates bilinearly and rounds halves up. `same` becomes the colour that shares the row with green,
// `other` the colour in the rows above and below.
void interpolate(const Neighbours& n, std::size_t x0, bool green_first, Shift shift, std::size_t pixels,
                 std::uint16_t* same, std::uint16_t* green, std::uint16_t* other) {
    const std::uint16_t *const up = n.before(x0, 0), *const here = n.before(x0, 1),
                               *const down = n.before(x0, 2);
    for (std::size_t i = 0; i < pixels; ++i) {
        const unsigned level = unsigned{here[i]} + here[i + 2], upright = unsigned{up[i + 1]} + down[i + 1];
        const unsigned corners = unsigned{up[i]} + up[i + 2] + down[i] + down[i + 2];
        const unsigned own = here[i + 1];
        const bool is_green = (i % 2 == 0) == green_first;
        same[i] = shift(is_green ? (level + 1) / 2 : own);
        green[i] = shift(is_green ? own : (level + upright + 2) / 4);
        other[i] = shift(is_green ? (upright + 1) / 2 : (corners + 2) / 4);
    }
}

// Calls emit(block) for all pixels, rows first.
template <class Emit>
void each_block(const PixelSource& s, BayerPattern pattern, std::span<std::uint16_t> scratch, Emit emit) {
    Neighbours n(s, scratch);
    Block block;
    for (int y = 0; y < s.crop.height; ++y) {
        if (!pattern.empty()) n.go_to(y);
        const BayerPattern row = pattern.empty() ? pattern : pattern.substr(y % 2 == 0 ? 0 : 2, 2);
        const bool red_row = row.find('R') != BayerPattern::npos;
        for (std::size_t x = 0; x < s.width(); x += Block::kPixels) {
            block.pixels = std::min(Block::kPixels, s.width() - x);
            if (pattern.empty()) {
                for (std::size_t i = 0; i < block.pixels; ++i)
                    block.r[i] = block.g[i] = block.b[i] = s.shift(s.row(y)[x + i]);
            } else {
                auto &same = red_row ? block.r : block.b, &other = red_row ? block.b : block.r;
                interpolate(n, x, row[0] == 'G', s.shift, block.pixels, same.data(), block.g.data(),
                            other.data());
            }
            emit(block);
        }
    }
}

void write_rgb(const PixelSource& s, BayerPattern pattern, std::span<std::uint16_t> scratch,
               std::uint8_t* out) {
    each_block(s, pattern, scratch, [&out](const Block& c) {
        for (std::size_t i = 0; i < c.pixels; ++i) {
            out[3 * i] = static_cast<std::uint8_t>(c.r[i]);
            out[3 * i + 1] = static_cast<std::uint8_t>(c.g[i]);
            out[3 * i + 2] = static_cast<std::uint8_t>(c.b[i]);
        }
        out += 3 * c.pixels;
    });
}

// ITU-R BT.601 luma and colour differences, full range (as JFIF 1.02, 1992), in 16-bit fixed point.
std::uint8_t luma(unsigned r, unsigned g, unsigned b) {
    return static_cast<std::uint8_t>((19595 * r + 38470 * g + 7471 * b + 32768) >> 16);
}
// Takes the sum of two pixels, so that one difference serves both.
std::uint8_t blue_difference(int r, int g, int b) {
    const int value = 32768 * b - 11059 * r - 21709 * g;
    return static_cast<std::uint8_t>(std::clamp(((value + 65536) >> 17) + 128, 0, 255));
}
std::uint8_t red_difference(int r, int g, int b) {
    const int value = 32768 * r - 27439 * g - 5329 * b;
    return static_cast<std::uint8_t>(std::clamp(((value + 65536) >> 17) + 128, 0, 255));
}

void write_yuyv(const PixelSource& s, BayerPattern pattern, std::span<std::uint16_t> scratch,
                std::uint8_t* out) {
    each_block(s, pattern, scratch, [&out](Block& c) {
        // The last pixel of an odd row is its own partner.
        if (c.pixels % 2 != 0)
            for (auto* const colour : {&c.r, &c.g, &c.b}) (*colour)[c.pixels] = (*colour)[c.pixels - 1];
        std::array<std::uint8_t, Block::kPixels> luma_of, difference;
        for (std::size_t i = 0; i < c.pixels; ++i) luma_of[i] = luma(c.r[i], c.g[i], c.b[i]);
        for (std::size_t i = 0; i < c.pixels; i += 2) {
            const int r = c.r[i] + c.r[i + 1], g = c.g[i] + c.g[i + 1], b = c.b[i] + c.b[i + 1];
            difference[i] = blue_difference(r, g, b);
            difference[i + 1] = red_difference(r, g, b);
        }
        for (std::size_t i = 0; i < c.pixels; ++i) out[2 * i] = luma_of[i], out[2 * i + 1] = difference[i];
        out += 2 * c.pixels;
    });
}

}  // namespace

std::string bayer_pattern_of(std::string_view rows) {
    if (rows.size() != 5 || rows[2] != ' ') return {};
    std::string pattern = std::string(rows.substr(0, 2)) + std::string(rows.substr(3, 2));
    for (const char* known : {"RGGB", "GRBG", "GBRG", "BGGR"})
        if (pattern == known) return pattern;
    return {};
}

BayerPattern shifted(BayerPattern pattern, int offset_x, int offset_y) {
    if (pattern.empty()) return pattern;
    // In kPatterns' order, one column further swaps 0 with 1 and 2 with 3; one row further swaps 0 with 3 and
    // 1 with 2.
    const std::uint32_t moved =
        place_of(pattern) ^ (offset_x % 2 != 0 ? 1u : 0u) ^ (offset_y % 2 != 0 ? 3u : 0u);
    return kPatterns[moved];
}

// Only the parity of an offset matters.
std::string bayer_pattern_of(const CameraModel& camera) {
    if (camera.binning_x > 1 || camera.binning_y > 1) return {};
    const PixelRectangle window = window_of(camera);
    return std::string(shifted(bayer_pattern_of(camera.color_filter.pattern),
                               window.left + static_cast<int>(camera.black_columns),
                               window.top + static_cast<int>(camera.black_rows)));
}

std::string pfnc_name(WireFormat format, BayerPattern pattern) {
    const Format& f = format_of(format);
    if (!f.mosaic) return std::string(f.name);
    return "Bayer" + std::string(kPatterns[place_of(pattern)].substr(0, 2)) + std::string(f.name);
}

std::uint32_t pfnc_code(WireFormat format, BayerPattern pattern) {
    const Format& f = format_of(format);
    return f.mosaic ? f.code + place_of(pattern) : f.code;
}

std::span<const WireFormat> formats_of(BayerPattern pattern) {
    using enum WireFormat;
    static constexpr std::array kMono = {kMono8,        kMono10,       kMono12,  kMono14,  kMono16,
                                         kMono10Packed, kMono12Packed, kMono10p, kMono12p, kRgb8};
    static constexpr std::array kColour = {kBayer8,  kBayer10, kBayer12, kBayer12Packed,
                                           kBayer16, kRgb8,    kYuyv};
    return pattern.empty() ? std::span<const WireFormat>(kMono) : std::span<const WireFormat>(kColour);
}

WireFormat native_format(int bits, BayerPattern pattern) {
    using enum WireFormat;
    if (!pattern.empty())
        return bits <= 8 ? kBayer8 : bits <= 10 ? kBayer10 : bits <= 12 ? kBayer12 : kBayer16;
    return bits <= 8 ? kMono8 : bits <= 10 ? kMono10 : bits <= 12 ? kMono12 : bits <= 14 ? kMono14 : kMono16;
}

namespace {

PixelLayout layout_of(WireFormat format) {
    switch (format) {
        case WireFormat::kMono10Packed:
            return {Packing::kGige, 10, 0};
        case WireFormat::kMono12Packed:
        case WireFormat::kBayer12Packed:
            return {Packing::kGige, 12, 0};
        case WireFormat::kMono10p:
            return {Packing::kPfnc, 10, 0};
        case WireFormat::kMono12p:
            return {Packing::kPfnc, 12, 0};
        default:
            return {Packing::kNone, 16, format_of(format).bits > 8 ? 16 : 8};
    }
}

}  // namespace

std::size_t wire_bytes(std::size_t pixels, WireFormat format) {
    if (format == WireFormat::kRgb8) return 3 * pixels;
    if (format == WireFormat::kYuyv) return 2 * pixels;
    return packed_bytes(pixels, layout_of(format));
}

void write_wire(const DnImage& frame, const Crop& crop, int bits, WireFormat format, BayerPattern pattern,
                std::span<std::uint16_t> row, std::span<std::uint8_t> out) {
    HILCAM_CHECK(crop.width > 0 && crop.height > 0 && crop.left >= 0 && crop.top >= 0 &&
                 crop.left + crop.width <= frame.width() && crop.top + crop.height <= frame.height());
    const PixelSource source{frame, crop, Shift(bits, format_of(format).bits)};
    HILCAM_CHECK(row.size() >= 3 * source.width() + 8);
    HILCAM_CHECK(out.size() == wire_bytes(source.width() * static_cast<std::size_t>(crop.height), format));
    if (format == WireFormat::kRgb8) return write_rgb(source, pattern, row, out.data());
    if (format == WireFormat::kYuyv) return write_yuyv(source, pattern, row, out.data());
    const PixelLayout layout = layout_of(format);
    if (layout.packing != Packing::kNone) return write_packed(source, layout, row.data(), out);
    if (layout.container_bits == 8) return write_bytes(source, out.data());
    write_words(source, row.data(), out.data());
}

void interpolate_colors(const DnImage& mosaic, BayerPattern pattern, std::span<std::uint16_t> row,
                        std::span<std::uint16_t> out) {
    const Crop all{0, 0, mosaic.width(), mosaic.height()};
    const PixelSource source{mosaic, all, Shift(16, 16)};
    HILCAM_CHECK(row.size() >= 3 * source.width() + 8 && out.size() == 3 * mosaic.pixels());
    std::uint16_t* to = out.data();
    each_block(source, pattern, row, [&to](const Block& c) {
        for (std::size_t i = 0; i < c.pixels; ++i, to += 3) to[0] = c.r[i], to[1] = c.g[i], to[2] = c.b[i];
    });
}

}  // namespace hilcam
