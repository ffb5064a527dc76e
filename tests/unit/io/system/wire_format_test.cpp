#include "io/system/wire_format.h"

#include <gmock/gmock.h>

#include <vector>

#include "sensor/camera_model.h"

namespace hilcam {
namespace {

using testing::ElementsAre;

DnImage image_of(int width, std::vector<std::uint16_t> dn) {
    DnImage image(width, static_cast<int>(dn.size()) / width);
    std::copy(dn.begin(), dn.end(), image.data());
    return image;
}

std::vector<std::uint8_t> wire(const DnImage& image, int bits, WireFormat format, BayerPattern pattern = {},
                               Crop crop = {}) {
    if (crop.width == 0) crop = {0, 0, image.width(), image.height()};
    const auto pixels = static_cast<std::size_t>(crop.width) * static_cast<std::size_t>(crop.height);
    // Guards behind what may be written.
    std::vector<std::uint16_t> row(3 * static_cast<std::size_t>(crop.width) + 8 + 1, 0xABCD);
    std::vector<std::uint8_t> out(wire_bytes(pixels, format) + 1, 0xEE);
    write_wire(image, crop, bits, format, pattern, std::span(row).first(row.size() - 1),
               std::span(out).first(out.size() - 1));
    EXPECT_EQ(row.back(), 0xABCD);
    EXPECT_EQ(out.back(), 0xEE);
    out.pop_back();
    return out;
}

// PFNC 2.4's values; those of GigE Vision 1.2 for the "Packed" ones.
TEST(WireFormat, NamesAndCodesAreTheConventions) {
    struct Row {
        WireFormat format;
        BayerPattern pattern;
        const char* name;
        std::uint32_t code;
    };
    using enum WireFormat;
    for (const Row& r : std::initializer_list<Row>{{kMono8, "", "Mono8", 0x01080001},
                                                   {kMono10, "", "Mono10", 0x01100003},
                                                   {kMono12, "", "Mono12", 0x01100005},
                                                   {kMono14, "", "Mono14", 0x01100025},
                                                   {kMono16, "", "Mono16", 0x01100007},
                                                   {kMono10Packed, "", "Mono10Packed", 0x010C0004},
                                                   {kMono12Packed, "", "Mono12Packed", 0x010C0006},
                                                   {kMono10p, "", "Mono10p", 0x010A0046},
                                                   {kMono12p, "", "Mono12p", 0x010C0047},
                                                   {kBayer8, "GRBG", "BayerGR8", 0x01080008},
                                                   {kBayer8, "RGGB", "BayerRG8", 0x01080009},
                                                   {kBayer8, "GBRG", "BayerGB8", 0x0108000A},
                                                   {kBayer8, "BGGR", "BayerBG8", 0x0108000B},
                                                   {kBayer10, "GRBG", "BayerGR10", 0x0110000C},
                                                   {kBayer10, "BGGR", "BayerBG10", 0x0110000F},
                                                   {kBayer12, "RGGB", "BayerRG12", 0x01100011},
                                                   {kBayer12Packed, "GRBG", "BayerGR12Packed", 0x010C002A},
                                                   {kBayer12Packed, "GBRG", "BayerGB12Packed", 0x010C002C},
                                                   {kBayer16, "RGGB", "BayerRG16", 0x0110002F},
                                                   {kBayer16, "BGGR", "BayerBG16", 0x01100031},
                                                   {kRgb8, "RGGB", "RGB8", 0x02180014},
                                                   {kYuyv, "", "YUV422_8", 0x02100032}}) {
        EXPECT_EQ(pfnc_name(r.format, r.pattern), r.name);
        EXPECT_EQ(pfnc_code(r.format, r.pattern), r.code) << r.name;
        // Bits 16 to 23 of a code: what a pixel takes.
        EXPECT_EQ(wire_bytes(8, r.format), r.code >> 16 & 0xFF) << r.name;
    }
}

TEST(WireFormat, AWindowsMosaicDependsOnWhereItBegins) {
    EXPECT_EQ(shifted("RGGB", 0, 0), "RGGB");
    EXPECT_EQ(shifted("RGGB", 1, 0), "GRBG");
    EXPECT_EQ(shifted("RGGB", 0, 1), "GBRG");
    EXPECT_EQ(shifted("RGGB", 1, 1), "BGGR");
    EXPECT_EQ(shifted("GBRG", 3, 0), "BGGR");
    EXPECT_EQ(shifted("BGGR", 2, 4), "BGGR");
    EXPECT_EQ(shifted("GRBG", 0, 5), "BGGR");
    EXPECT_EQ(shifted("", 1, 1), "");
}

TEST(WireFormat, ACamerasFramesBeginWhereItsWindowAndBlackPixelsSay) {
    CameraModel c;
    c.width_px = c.height_px = 64;
    c.color_filter.pattern = "RG GB";
    EXPECT_EQ(bayer_pattern_of(c), "RGGB");
    c.window_px = {1, 0, 20, 20};
    EXPECT_EQ(bayer_pattern_of(c), "GRBG");
    c.window_px = {7, 3, 20, 20};
    EXPECT_EQ(bayer_pattern_of(c), "BGGR");
    c.black_columns = 1;
    EXPECT_EQ(bayer_pattern_of(c), "GBRG");
    c.black_rows = 3;
    EXPECT_EQ(bayer_pattern_of(c), "RGGB");
    c.binning_x = 2;
    EXPECT_EQ(bayer_pattern_of(c), "") << "colours are mixed";
}

TEST(WireFormat, TheCamerasOwnFormatKeepsEveryBit) {
    using enum WireFormat;
    const auto native = [](BayerPattern p) {
        std::vector<WireFormat> out;
        for (const int bits : {7, 8, 10, 11, 12, 14, 16}) out.push_back(native_format(bits, p));
        return out;
    };
    EXPECT_THAT(native(""), ElementsAre(kMono8, kMono8, kMono10, kMono12, kMono12, kMono14, kMono16));
    EXPECT_THAT(native("RGGB"),
                ElementsAre(kBayer8, kBayer8, kBayer10, kBayer12, kBayer12, kBayer16, kBayer16));
    for (const BayerPattern p : {BayerPattern(""), BayerPattern("GBRG")})
        for (const int bits : {8, 10, 12, 14, 16})
            EXPECT_THAT(formats_of(p), testing::Contains(native_format(bits, p)));
}

TEST(WireFormat, FewerBitsAreTheUpperOnesMoreBitsAPowerOfTwo) {
    using enum WireFormat;
    const DnImage image = image_of(3, {0x000, 0x123, 0xFFF});
    EXPECT_THAT(wire(image, 12, kMono8), ElementsAre(0x00, 0x12, 0xFF));
    EXPECT_THAT(wire(image, 12, kMono10), ElementsAre(0, 0, 0x48, 0x00, 0xFF, 0x03));
    EXPECT_THAT(wire(image, 12, kMono12), ElementsAre(0, 0, 0x23, 0x01, 0xFF, 0x0F));
    EXPECT_THAT(wire(image, 12, kMono14), ElementsAre(0, 0, 0x8C, 0x04, 0xFC, 0x3F));
    EXPECT_THAT(wire(image, 12, kMono16), ElementsAre(0, 0, 0x30, 0x12, 0xF0, 0xFF));
    // The mosaic's formats are the same numbers.
    EXPECT_EQ(wire(image, 12, kBayer8, "RGGB"), wire(image, 12, kMono8));
    EXPECT_EQ(wire(image, 12, kBayer10, "RGGB"), wire(image, 12, kMono10));
    EXPECT_EQ(wire(image, 12, kBayer12, "RGGB"), wire(image, 12, kMono12));
    EXPECT_EQ(wire(image, 12, kBayer12Packed, "RGGB"), wire(image, 12, kMono12Packed));
    EXPECT_EQ(wire(image, 12, kBayer16, "RGGB"), wire(image, 12, kMono16));
    // A camera of fewer bits than the format, and of all bits.
    EXPECT_THAT(wire(image_of(2, {0x01, 0x0F}), 4, kMono8), ElementsAre(0x10, 0xF0));
    EXPECT_THAT(wire(image_of(1, {0xFFFF}), 16, kMono12), ElementsAre(0xFF, 0x0F));
    EXPECT_THAT(wire(image_of(1, {0xFEDC}), 16, kMono16), ElementsAre(0xDC, 0xFE));
}

// Rows of packed pixels follow each other without a gap: an odd width puts a row's last pixel and the next
// row's first one into the same bytes.
TEST(WireFormat, PackedRowsOfOddWidthShareBytes) {
    using enum WireFormat;
    const DnImage image = image_of(3, {0x123, 0x456, 0x789, 0xABC, 0xDEF, 0x012});
    EXPECT_THAT(wire(image, 12, kMono12Packed),
                ElementsAre(0x12, 0x63, 0x45, 0x78, 0xC9, 0xAB, 0xDE, 0x2F, 0x01));
    EXPECT_THAT(wire(image, 12, kMono12p), ElementsAre(0x23, 0x61, 0x45, 0x89, 0xC7, 0xAB, 0xEF, 0x2D, 0x01));
    // An odd number of pixels: half of the last byte is empty.
    const Crop one_row{0, 0, 3, 1};
    EXPECT_THAT(wire(image, 12, kMono12Packed, "", one_row), ElementsAre(0x12, 0x63, 0x45, 0x78, 0x09));
    EXPECT_THAT(wire(image, 12, kMono12p, "", one_row), ElementsAre(0x23, 0x61, 0x45, 0x89, 0x07));
    // 10 bits: groups of four, 3 + 3 + 1 pixels.
    const DnImage ten = image_of(1, {0x3FF, 0x000, 0x155, 0x2AA, 0x001, 0x3FF, 0x200});
    EXPECT_THAT(wire(ten, 10, kMono10p), ElementsAre(0xFF, 0x03, 0x50, 0x95, 0xAA, 0x01, 0xFC, 0x0F, 0x20));
    EXPECT_THAT(wire(ten, 10, kMono10Packed),
                ElementsAre(0xFF, 0x03, 0x00, 0x55, 0x21, 0xAA, 0x00, 0x31, 0xFF, 0x80, 0x00));
}

TEST(WireFormat, ACropIsTheSameAsThatPartOfTheFrame) {
    DnImage image(7, 5);
    for (std::size_t i = 0; i < image.pixels(); ++i) image.data()[i] = static_cast<std::uint16_t>(i * 101);
    const Crop crop{2, 1, 3, 2};
    DnImage part(3, 2);
    for (int y = 0; y < 2; ++y) std::copy_n(image.row(1 + y).data() + 2, 3, part.row(y).data());
    for (const WireFormat f : formats_of(""))
        EXPECT_EQ(wire(image, 12, f, "", crop), wire(part, 12, f)) << pfnc_name(f, "");
}

// A mosaic of one colour each: interpolation must give that colour everywhere, edges included, whatever the
// phase.
TEST(WireFormat, EvenColoursComeOutAsTheyAre) {
    for (const BayerPattern pattern : {"RGGB", "GRBG", "GBRG", "BGGR"}) {
        for (const int width : {4, 5}) {
            DnImage image(width, 3);
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < width; ++x) {
                    const char colour = pattern[static_cast<std::size_t>(y % 2 * 2 + x % 2)];
                    image.row(y)[static_cast<std::size_t>(x)] = colour == 'R'   ? 0x400
                                                                : colour == 'G' ? 0x800
                                                                                : 0xFFF;
                }
            const auto rgb = wire(image, 12, WireFormat::kRgb8, pattern);
            for (std::size_t i = 0; i < rgb.size(); i += 3)
                EXPECT_THAT(std::vector(rgb.begin() + static_cast<std::ptrdiff_t>(i),
                                        rgb.begin() + static_cast<std::ptrdiff_t>(i) + 3),
                            ElementsAre(0x40, 0x80, 0xFF))
                    << pattern << " pixel " << i / 3;
        }
    }
}

// By hand, of an 8-bit RGGB mosaic.
TEST(WireFormat, ColoursAreInterpolatedFromTheNearest) {
    const DnImage image = image_of(4, {10, 20, 30, 40,     //
                                       50, 60, 70, 80,     //
                                       90, 100, 110, 120,  //
                                       130, 140, 150, 160});
    const auto rgb = wire(image, 8, WireFormat::kRgb8, "RGGB");
    const auto at = [&](std::size_t x, std::size_t y) {
        const std::size_t i = 3 * (4 * y + x);
        return std::array<int, 3>{rgb[i], rgb[i + 1], rgb[i + 2]};
    };
    // Blue's place (1, 1): red of the four corners, green of the four sides.
    EXPECT_EQ(at(1, 1), (std::array{(10 + 30 + 90 + 110) / 4, (20 + 50 + 70 + 100) / 4, 60}));
    // Green in a blue row (2, 1): red above and below, blue left and right.
    EXPECT_EQ(at(2, 1), (std::array{(30 + 110) / 2, 70, (60 + 80) / 2}));
    // Green in a red row (1, 2).
    EXPECT_EQ(at(1, 2), (std::array{(90 + 110) / 2, 100, (60 + 140) / 2}));
    // Red's place (2, 2).
    EXPECT_EQ(at(2, 2), (std::array{110, (70 + 100 + 120 + 150) / 4, (60 + 80 + 140 + 160) / 4}));
    // A corner: the neighbours that are there stand for those that are not.
    EXPECT_EQ(at(0, 0), (std::array{10, (20 + 50) / 2, 60}));
    EXPECT_EQ(at(3, 3), (std::array{110, (120 + 150) / 2, 160}));
}

// A window's colours do not depend on the window: its neighbours outside are used.
TEST(WireFormat, AWindowHasTheColoursOfTheFrame) {
    DnImage image(8, 6);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        image.data()[i] = static_cast<std::uint16_t>(i * 7919 % 4096);
    const auto whole = wire(image, 12, WireFormat::kRgb8, "GBRG");
    for (const auto& [left, top] : {std::pair{0, 0}, {1, 0}, {0, 1}, {3, 3}, {5, 2}}) {
        const Crop crop{left, top, 3, 3};
        const auto part = wire(image, 12, WireFormat::kRgb8, shifted("GBRG", left, top), crop);
        for (int y = 0; y < 3; ++y)
            EXPECT_TRUE(std::equal(part.begin() + 9 * y, part.begin() + 9 * y + 9,
                                   whole.begin() + 3 * (8 * (top + y) + left)))
                << left << " " << top << " row " << y;
    }
}

// Luma and colour differences of BT.601, full range: primaries by hand, Y = 0.299 R + 0.587 G + 0.114 B,
// Cb = 128 + (B - Y) / 1.772, Cr = 128 + (R - Y) / 1.402, held to 255.
TEST(WireFormat, YuyvIsFullRangeBt601) {
    const auto even = [](std::uint16_t r, std::uint16_t g, std::uint16_t b) {
        const auto out = wire(image_of(4, {r, g, r, g, g, b, g, b}), 8, WireFormat::kYuyv, "RGGB");
        EXPECT_TRUE(std::equal(out.begin(), out.begin() + 4, out.begin() + 4));
        return std::vector(out.begin(), out.begin() + 4);
    };
    EXPECT_THAT(even(255, 255, 255), ElementsAre(255, 128, 255, 128));
    EXPECT_THAT(even(0, 0, 0), ElementsAre(0, 128, 0, 128));
    EXPECT_THAT(even(255, 0, 0), ElementsAre(76, 85, 76, 255));
    EXPECT_THAT(even(0, 255, 0), ElementsAre(150, 44, 150, 21));
    EXPECT_THAT(even(0, 0, 255), ElementsAre(29, 255, 29, 107));
    // Without filters: grey. An odd width leaves a half pair, luma and the first difference.
    EXPECT_THAT(wire(image_of(3, {16, 32, 255}), 8, WireFormat::kYuyv),
                ElementsAre(16, 128, 32, 128, 255, 128));
    EXPECT_THAT(wire(image_of(2, {16, 255}), 8, WireFormat::kRgb8), ElementsAre(16, 16, 16, 255, 255, 255));
}

}  // namespace
}  // namespace hilcam
