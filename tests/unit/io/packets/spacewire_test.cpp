// SpaceWire packets byte by byte, against ECSS-E-ST-50-53C and ECSS-E-ST-50-52C.

#include "io/packets/spacewire.h"

#include <gmock/gmock.h>

#include <string_view>

#include "io/packets/rmap.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

// Test patterns of ECSS-E-ST-50-52C, annex A.4.
TEST(Rmap, TheCrcIsThatOfTheStandardsTestPatterns) {
    const Bytes rising = {1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_EQ(rmap_crc(rising), 0xB0);
    constexpr std::string_view kText = "SpaceWire is beautiful!!";
    EXPECT_EQ(rmap_crc(Bytes(kText.begin(), kText.end())), 0x84);
    const Bytes random = {0x10, 0x56, 0xC3, 0x95, 0xA5, 0x75, 0x38, 0x63,
                          0x2F, 0x86, 0x7B, 0x01, 0x32, 0xDE, 0x35, 0x7A};
    EXPECT_EQ(rmap_crc(random), 0x18);
    Bytes closed = random;
    closed.push_back(0x18);
    EXPECT_EQ(rmap_crc(closed), 0);
}

TEST(Rmap, AWriteCommandHasItsFieldsAtTheirPlaces) {
    Bytes out = {0x77};
    const Bytes data = {1, 2, 3, 4, 5, 6, 7, 8};
    append_rmap_write({.target = 0x42,
                       .key = 0x21,
                       .initiator = 0x67,
                       .transaction = 0x1234,
                       .extended_address = 9,
                       .address = 0xA0000010},
                      data, out);
    const Bytes header = {0x42, 0x01, 0x64, 0x21, 0x67, 0x12, 0x34, 0x09, 0xA0, 0, 0, 0x10, 0, 0, 8};
    ASSERT_EQ(out.size(), 1 + 16 + 8 + 1u);
    EXPECT_EQ(Bytes(out.begin() + 1, out.begin() + 16), header);
    EXPECT_EQ(out[16], rmap_crc(header));
    EXPECT_EQ(Bytes(out.begin() + 17, out.end() - 1), data);
    EXPECT_EQ(out.back(), 0xB0);
}

TEST(SpaceWire, ACcsdsPacketFollowsFourBytes) {
    SpaceWireConfig config;
    config.target = 0x45, config.user_application = 0x17;
    SpaceWireWrapper bare(config, false);
    const Bytes packet = {1, 2, 3};
    const auto wrapped = bare.wrap(packet);
    EXPECT_EQ(Bytes(wrapped.begin(), wrapped.end()), (Bytes{0x45, 0x02, 0x00, 0x17, 1, 2, 3}));
    EXPECT_EQ(wrapped.size(), packet.size() + added_bytes(config));
}

TEST(SpaceWire, InAStreamALengthGoesBeforeThePath) {
    SpaceWireConfig config;
    config.path_address = {3, 1};
    SpaceWireWrapper stream(config, true);
    const auto wrapped = stream.wrap(Bytes{9});
    EXPECT_EQ(Bytes(wrapped.begin(), wrapped.end()), (Bytes{0, 0, 0, 7, 3, 1, 0xFE, 0x02, 0, 0, 9}));
}

TEST(SpaceWire, RmapWritesFillTheSlotsInTurn) {
    SpaceWireConfig config;
    config.protocol = SpaceWireConfig::Protocol::kRmap;
    config.address = 0x1000, config.slots = 2, config.slot_bytes = 0x100;
    SpaceWireWrapper wrapper(config, false);
    for (const int upper : {0x10, 0x11, 0x10, 0x11}) {
        const auto wrapped = wrapper.wrap(Bytes{9});
        EXPECT_EQ(wrapped[2], 0x64) << "increments";
        EXPECT_EQ(wrapped[10], upper);
        EXPECT_EQ(wrapped.size(), 1 + added_bytes(config));
    }
    config.slots = 0;
    SpaceWireWrapper fifo(config, false);
    for (int i = 0; i < 2; ++i) {
        const auto wrapped = fifo.wrap(Bytes{9});
        EXPECT_EQ(wrapped[2], 0x60) << "does not increment";
        EXPECT_EQ(wrapped[6], i) << "transaction";
        EXPECT_EQ(wrapped[10], 0x10);
    }
}

std::string refusal(const SpaceWireConfig& config) {
    try {
        validate(config);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(SpaceWire, SlotsEndWithTheAddresses) {
    SpaceWireConfig config;
    config.protocol = SpaceWireConfig::Protocol::kRmap;
    config.address = 0xFFFF0000, config.slots = 1;
    EXPECT_EQ(refusal(config), "none");
    config.slots = 2;
    EXPECT_THAT(refusal(config), HasSubstr("slots: found 2 slots of 65536 bytes; accepted: slots that end"));
    config = {};
    config.path_address = {1.5};
    EXPECT_THAT(refusal(config), HasSubstr("path_address: found a number that is not whole"));
}

}  // namespace
}  // namespace hilcam
