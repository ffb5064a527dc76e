// Another camera's chunks: ids, places and numbers as its description has them.

#include "io/gige/stream/gige_chunk_layout.h"

#include <gtest/gtest.h>

#include "io/gige/stream/gige_packets.h"
#include "io/system/bytes.h"

namespace hilcam {
namespace {

FaceTable table() {
    FaceTable t;
    t.image_chunk_id = 0x5000;
    FaceChunk frame{.id = 0x5041, .bytes = 8};
    RegisterFormula upper{.scale = 4294967296.0};
    frame.fields.push_back({"FrameID", {.address = 0}, {}, {}});
    frame.fields.push_back({"FrameID", {.address = 4}, upper, {}});
    FaceChunk exposure{.id = 0x5043, .bytes = 4};
    exposure.fields.push_back({"ExposureTime", {.address = 0, .little_endian = true}, {.scale = 0.1}, {}});
    FaceChunk format{.id = 0x5044, .bytes = 4};
    format.fields.push_back({"PixelFormat", {.address = 0}, {}, {{7, "Mono8", 0}, {9, "Mono12", 0}}});
    FaceChunk newer{.id = 0x5045, .bytes = 4};
    newer.fields.push_back({"Weather", {.address = 0}, {}, {}});
    t.chunks = {frame, exposure, format, newer};
    return t;
}

GigeStreamState state(const GigeChunkLayout& layout) {
    GigeStreamState s;
    s.width = 4, s.height = 2;
    s.format = WireFormat::kMono12;
    s.chunk_mode = true, s.chunks = ~0u;
    s.chunk_layout = &layout;
    return s;
}

TEST(GigeChunkLayout, ChunksFollowTheImageWithTheirIdsAndLengths) {
    const GigeChunkLayout layout = chunk_layout_of(table(), {});
    ASSERT_EQ(layout.parts.size(), 3u);  // what hilcam cannot say is left out
    const GigeStreamState s = state(layout);
    EXPECT_EQ(s.payload_bytes(), 16u + 8 + (8 + 8) + (4 + 8) + (4 + 8));
    FrameRecord record;
    record.id = 0x0000000512345678;
    record.exposure_s = 150e-6;
    std::vector<std::uint8_t> out(s.payload_bytes(), 0xEE);
    std::vector<std::uint16_t> scratch(3 * 4 + 8);
    write_gige_payload(DnImage(4, 2), record, s, {}, 1, scratch, out);
    const std::span<const std::uint8_t> all = out;
    ByteReader in(all.subspan(16));
    EXPECT_EQ(in.u32(), 0x5000u);
    EXPECT_EQ(in.u32(), 16u);
    EXPECT_EQ(in.u32(), 0x12345678u);
    EXPECT_EQ(in.u32(), 5u);
    EXPECT_EQ(in.u32(), 0x5041u);
    EXPECT_EQ(in.u32(), 8u);
    EXPECT_EQ(in.u32(), 0xDC050000u);  // 1500 = 0x5DC, little-endian
    EXPECT_EQ(in.u32(), 0x5043u);
    EXPECT_EQ(in.u32(), 4u);
    EXPECT_EQ(in.u32(), 9u);
    EXPECT_EQ(in.u32(), 0x5044u);
    EXPECT_EQ(in.u32(), 4u);
    EXPECT_EQ(in.left(), 0u);
}

TEST(GigeChunkLayout, AChunkThatIsOffIsNotThere) {
    const GigeChunkLayout layout = chunk_layout_of(table(), {});
    GigeStreamState s = state(layout);
    s.chunks = 1u << static_cast<unsigned>(Chunk::kExposureTime);
    EXPECT_EQ(s.chunk_data_bytes(), 8u + 4 + 8);
    s.chunk_mode = false;
    EXPECT_EQ(s.chunk_data_bytes(), 0u);
}

}  // namespace
}  // namespace hilcam
