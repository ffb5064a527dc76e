#include "io/lines/edge_codec.h"

#include <gtest/gtest.h>

#include <vector>

namespace hilcam {
namespace {

// The bytes of docs/lines.md.
TEST(EdgeCodec, AnEdgeIsTwentyFourBytes) {
    const EdgeDatagram edge{2, true, EdgeClock::kTai, 1, 0x01020304, 0x0A0B0C0D0E0F1011};
    const std::array<std::uint8_t, kEdgeBytes> bytes = {'H',  'E',  'D',  'G',  1,    2,    1,    2,
                                                        0,    1,    0,    0,    1,    2,    3,    4,
                                                        0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F, 0x10, 0x11};
    EXPECT_EQ(encode_edge(edge), bytes);
    EXPECT_EQ(decode_edge(bytes), edge);
}

TEST(EdgeCodec, WhatIsNoEdgeIsRefused) {
    const auto good = encode_edge({0, true, EdgeClock::kNow, 0, 0, 0});
    ASSERT_TRUE(decode_edge(good));
    for (std::size_t size = 0; size < kEdgeBytes; ++size)
        EXPECT_FALSE(decode_edge(std::span(good).first(size))) << size;
    const std::vector<std::uint8_t> longer(kEdgeBytes + 1);
    EXPECT_FALSE(decode_edge(longer));
    const struct {
        std::size_t at;
        std::uint8_t value;
    } wrong[] = {{0, 'X'}, {3, 'X'}, {4, 2}, {5, 8}, {6, 2}, {7, 3}, {10, 1}, {11, 1}, {23, 1}};
    for (const auto& [at, value] : wrong) {
        auto bytes = good;
        bytes[at] = value;
        EXPECT_FALSE(decode_edge(bytes)) << at;
    }
    auto timeless = good;
    timeless[7] = 1;  // CLOCK_MONOTONIC, and no time
    EXPECT_FALSE(decode_edge(timeless));
}

}  // namespace
}  // namespace hilcam
