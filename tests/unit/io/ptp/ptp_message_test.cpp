// The bytes of PTP messages, written by hand from IEEE 1588-2008: tables 18 (header), 25 (Announce), 26 (Sync
// and Delay_Req), 27 (Follow_Up) and 28 (Delay_Resp).

#include "io/ptp/ptp_message.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hilcam::ptp {
namespace {

using Bytes = std::vector<std::uint8_t>;

// type and version, length, domain, flags, correction (1.5 ns), source, sequence, control, log interval.
Bytes header(std::uint8_t type, std::uint8_t length, std::uint8_t control) {
    return {type, 0x02, 0x00, length, 0x05, 0x00, 0x02, 0x0C, 0,       0,    0,    0,
            0,    0x01, 0x80, 0x00,   0,    0,    0,    0,    0x00,    0x1B, 0x19, 0xFF,
            0xFE, 0x12, 0x34, 0x56,   0x00, 0x03, 0xFF, 0xFE, control, 0xFD};
}
// 2^32 + 2 s would be out of range; 0x65920080 s = 2024-01-01T00:00:00, 0x075BCD15 = 123456789 ns.
const Bytes kTime = {0x00, 0x00, 0x65, 0x92, 0x00, 0x80, 0x07, 0x5B, 0xCD, 0x15};
constexpr std::int64_t kTime_ns = 1'704'067'200'123'456'789;

Bytes joined(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
Bytes sync() { return joined(header(0x00, 44, 0), kTime); }
Bytes delay_response() {
    return joined(joined(header(0x09, 54, 3), kTime), {0x02, 0, 0, 0xFF, 0xFE, 0, 0, 0x01, 0x00, 0x01});
}
Bytes announce() {
    return joined(header(0x0B, 64, 5),
                  {0,    0,    0,    0,    0,    0,    0, 0, 0, 0,  // origin
                   0x00, 0x25, 0,    0x80, 0x06, 0x21,              // 37 s, priority, class, accuracy
                   0x4E, 0x5D, 0x7F,                                // variance, priority
                   0x00, 0x1B, 0x19, 0xFF, 0xFE, 0,    0, 9,        // grandmaster
                   0x00, 0x02, 0x20});                              // steps, GPS
}

TEST(PtpMessage, ASyncIsReadByteByByte) {
    const auto m = read_message(sync());
    ASSERT_TRUE(m);
    EXPECT_EQ(m->type, MessageType::kSync);
    EXPECT_EQ(m->domain, 5);
    EXPECT_TRUE(m->has(flag::kTwoStep));
    EXPECT_TRUE(m->has(flag::kPtpTimescale));
    EXPECT_TRUE(m->has(flag::kUtcOffsetValid));
    EXPECT_FALSE(m->has(flag::kAlternateMaster));
    EXPECT_EQ(m->correction_scaled_ns, 3 * 65536 / 2);
    EXPECT_EQ(m->source, (PortIdentity{0x001B19FFFE123456, 3}));
    EXPECT_EQ(m->sequence, 0xFFFE);
    EXPECT_EQ(m->log_interval, -3);
    EXPECT_EQ(m->time_ns, kTime_ns);
}

TEST(PtpMessage, AnAnnounceSaysWhoTheMasterIs) {
    const auto m = read_message(announce());
    ASSERT_TRUE(m);
    const Announce& a = m->announce;
    EXPECT_EQ(a.utc_offset_s, 37);
    EXPECT_EQ(a.priority1, 128);
    EXPECT_EQ(a.clock_class, 6);
    EXPECT_EQ(a.accuracy, 0x21);
    EXPECT_EQ(a.variance, 0x4E5D);
    EXPECT_EQ(a.priority2, 127);
    EXPECT_EQ(a.grandmaster, 0x001B19FFFE000009u);
    EXPECT_EQ(a.steps_removed, 2);
    EXPECT_EQ(a.time_source, 0x20);
}

TEST(PtpMessage, ADelayResponseNamesTheRequester) {
    const auto m = read_message(delay_response());
    ASSERT_TRUE(m);
    EXPECT_EQ(m->time_ns, kTime_ns);
    EXPECT_EQ(m->requester, (PortIdentity{0x020000FFFE000001, 1}));
}

TEST(PtpMessage, WrittenBytesAreTheOnesThatWereRead) {
    for (const Bytes& bytes : {sync(), announce(), delay_response(), joined(header(0x08, 44, 2), kTime),
                               joined(header(0x01, 44, 1), kTime)}) {
        std::array<std::uint8_t, kMaxMessageBytes> out{};
        const auto m = read_message(bytes);
        ASSERT_TRUE(m);
        const std::size_t size = write_message(*m, out);
        EXPECT_EQ(Bytes(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size)), bytes);
    }
}

TEST(PtpMessage, WhatIsBehindTheMessageIsNotRead) {
    EXPECT_TRUE(read_message(joined(sync(), Bytes(18, 0xFF))));  // an Ethernet frame's padding
    Bytes with_tlv = joined(announce(), {0x00, 0x08, 0x00, 0x02, 0xAA, 0xBB});
    with_tlv[3] = 70;
    EXPECT_TRUE(read_message(with_tlv));
}

TEST(PtpMessage, TheMinorVersionOf2019IsReadAs2008) {
    Bytes bytes = sync();
    bytes[1] = 0x12;
    EXPECT_TRUE(read_message(bytes));
}

TEST(PtpMessage, OtherBytesAreNoMessage) {
    const auto with = [](Bytes bytes, std::size_t at, std::uint8_t value) {
        bytes[at] = value;
        return read_message(bytes).has_value();
    };
    const Bytes whole = announce();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(read_message(std::span(whole).first(size))) << size;
    EXPECT_FALSE(with(sync(), 1, 0x01));   // version 1
    EXPECT_FALSE(with(sync(), 0, 0x10));   // IEEE 802.1AS
    EXPECT_FALSE(with(sync(), 0, 0x02));   // Pdelay_Req
    EXPECT_FALSE(with(sync(), 0, 0x0D));   // management
    EXPECT_FALSE(with(sync(), 3, 43));     // shorter than a Sync
    EXPECT_FALSE(with(sync(), 3, 45));     // longer than what came
    EXPECT_FALSE(with(sync(), 35, 0x01));  // 2^32 s
    EXPECT_FALSE(with(sync(), 36, 0xFF));  // the year 2105
    EXPECT_FALSE(with(sync(), 40, 0x3C));  // more than 999'999'999 ns
    EXPECT_FALSE(with(sync(), 8, 0x7F));   // a correction of 26 days
    EXPECT_FALSE(with(sync(), 8, 0x80));   // a negative one
}

TEST(PtpMessage, AClockIdentityIsMadeOfTheMacAddress) {
    EXPECT_EQ(identity_of_mac(0x001B19123456), 0x001B19FFFE123456u);
}

}  // namespace
}  // namespace hilcam::ptp
