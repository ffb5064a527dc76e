// Payloads of packets. Raw and packed ones are compared byte by byte; that compressed ones decode to the same
// DN is shown by tests/protocol/image_packets_test.py with the libraries' decoders.

#include "io/packets/payload_encoder.h"

#include <gmock/gmock.h>

#include "io/system/loaded_library.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes encoded(Payload payload, const std::vector<std::uint16_t>& dn, int width, int bits) {
    Bytes out = {0xAA};  // what is there stays
    make_payload_encoder(payload)->encode({dn, width, static_cast<int>(dn.size()) / width, bits}, out);
    EXPECT_EQ(out.front(), 0xAA);
    return {out.begin() + 1, out.end()};
}

// Smooth, as pictures are, with some noise, which no compression can remove.
std::vector<std::uint16_t> picture(int width, int height, int bits) {
    std::vector<std::uint16_t> dn;
    std::uint32_t noise = 1;
    const int most = (1 << bits) - 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            noise = noise * 1664525u + 1013904223u;
            dn.push_back(static_cast<std::uint16_t>(
                (most * (x + y) / (width + height) + static_cast<int>(noise >> 30)) & most));
        }
    return dn;
}

TEST(PayloadEncoder, RawPixelsAreTwoBytesEach) {
    EXPECT_EQ(encoded(Payload::kRawLittleEndian, {0x0123, 0x0FED}, 2, 12), (Bytes{0x23, 0x01, 0xED, 0x0F}));
    EXPECT_EQ(encoded(Payload::kRawBigEndian, {0x0123, 0x0FED}, 2, 12), (Bytes{0x01, 0x23, 0x0F, 0xED}));
}

TEST(PayloadEncoder, PackedPixelsHaveNoGaps) {
    // Mono12p of PFNC: the first pixel's lower byte; its upper bits below the second's lower ones; ...
    EXPECT_EQ(encoded(Payload::kPacked, {0x123, 0xFED}, 2, 12), (Bytes{0x23, 0xD1, 0xFE}));
    EXPECT_EQ(encoded(Payload::kPacked, {0x123, 0xFED, 0x456}, 3, 12), (Bytes{0x23, 0xD1, 0xFE, 0x56, 0x04}));
    EXPECT_EQ(encoded(Payload::kPacked, {0x3FF, 0, 0x3FF, 0}, 2, 10), (Bytes{0xFF, 0x03, 0xF0, 0x3F, 0}));
}

TEST(PayloadEncoder, AStripIsRowsOfAFrame) {
    DnImage frame(2, 3);
    for (std::size_t i = 0; i < 6; ++i) frame.all()[i] = static_cast<std::uint16_t>(i);
    const Strip strip = strip_of(frame, 1, 2, 10);
    EXPECT_EQ(std::vector<std::uint16_t>(strip.dn.begin(), strip.dn.end()),
              (std::vector<std::uint16_t>{2, 3, 4, 5}));
    EXPECT_EQ(strip.width, 2);
    EXPECT_EQ(strip.rows, 2);
    EXPECT_EQ(strip.bits, 10);
}

// Each compression, at each number of bits that cameras have, of pictures and of noise.
TEST(PayloadEncoder, CompressionsHoldAnyPicture) {
    for (const Payload payload : {Payload::kCcsds121, Payload::kJpegLs, Payload::kJpeg2000})
        for (const int bits : {8, 10, 11, 12, 14, 16})
            for (const auto& [width, height] : {std::pair{1, 1}, {5, 3}, {64, 48}, {257, 129}}) {
                const auto smooth = picture(width, height, bits);
                const std::size_t bytes = encoded(payload, smooth, width, bits).size();
                EXPECT_GT(bytes, 0u);
                if (width > 60) {
                    EXPECT_LT(bytes, smooth.size() * static_cast<std::size_t>(bits) / 8);
                }
                std::vector<std::uint16_t> noise;
                std::uint32_t state = 7;
                for (std::size_t i = 0; i < smooth.size(); ++i) {
                    state = state * 1664525u + 1013904223u;
                    noise.push_back(static_cast<std::uint16_t>(state >> (32 - bits)));
                }
                EXPECT_GE(encoded(payload, noise, width, bits).size(), bytes);
            }
}

// Begins of the streams: T.87, C.1 (SOI, SOF55 or another marker); T.800, A.4 (SOC, SIZ).
TEST(PayloadEncoder, CompressedPicturesBeginAsTheirStandardsSay) {
    const auto dn = picture(64, 48, 12);
    const Bytes ls = encoded(Payload::kJpegLs, dn, 64, 12), j2k = encoded(Payload::kJpeg2000, dn, 64, 12);
    EXPECT_EQ(Bytes(ls.begin(), ls.begin() + 4), (Bytes{0xFF, 0xD8, 0xFF, 0xF7}));
    EXPECT_EQ(Bytes(j2k.begin(), j2k.begin() + 4), (Bytes{0xFF, 0x4F, 0xFF, 0x51}));
    EXPECT_EQ(Bytes(j2k.end() - 2, j2k.end()), (Bytes{0xFF, 0xD9}));
}

TEST(LoadedLibrary, OneThatIsMissingIsNamedWithItsPackage) {
    try {
        const LoadedLibrary library("libhilcam-is-not-there.so.1", "outputs.packets.payload: x", "libx1");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "outputs.packets.payload: x needs libhilcam-is-not-there.so.1, which is not installed; "
                     "accepted: with it (apt install libx1)");
    }
}

TEST(LoadedLibrary, AFunctionThatIsMissingIsNamed) {
    const LoadedLibrary library("libc.so.6", "a test", "libc6");
    int (*function)() = nullptr;
    library.find(function, "getpid");
    EXPECT_GT(function(), 0);
    try {
        library.find(function, "hilcam_is_not_there");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "libc.so.6 has no function hilcam_is_not_there");
    }
}

}  // namespace
}  // namespace hilcam
