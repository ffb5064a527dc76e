#include "io/gige/device/gvcp.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace hilcam::gvcp {
namespace {

using testing::ElementsAreArray;

std::vector<std::uint8_t> bytes(const std::string& hex) {
    std::vector<std::uint8_t> out;
    std::string digits;
    for (const char c : hex)
        if (c != ' ') digits += c;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        out.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    return out;
}

// As Aravis 0.8.26 sends it on connecting.
TEST(Gvcp, ReadsAravissFirstCommands) {
    const auto discovery = read_header(bytes("42 01 0002 0000 ffff"));
    ASSERT_TRUE(discovery);
    EXPECT_EQ(discovery->command, kDiscovery);
    EXPECT_EQ(discovery->request_id, 0xFFFF);
    const auto url = bytes("42 01 0084 0008 ff15 00000200 0000 0200");
    ASSERT_TRUE(read_header(url));
    const auto range = read_memory_range(std::span(url).subspan(8));
    ASSERT_TRUE(range);
    EXPECT_EQ(range->address, 0x200u);
    EXPECT_EQ(range->bytes, 512);
    EXPECT_EQ(read_header(bytes("42 01 0082 0008 ff20 00000a00 00000002"))->command, kWriteRegister);
}

TEST(Gvcp, WhatIsNoCommandIsNone) {
    for (const char* text : {"", "42", "42 01 0002 0000", "43 01 0002 0000 0001", "42 01 0002 0000 0000"})
        EXPECT_FALSE(read_header(bytes(text))) << text;
}

TEST(Gvcp, HeadersAreWhatWasWritten) {
    std::vector<std::uint8_t> out(8);
    write_answer_header({kAccessDenied, kWriteRegister + 1, 4, 0x1234}, out);
    EXPECT_THAT(out, ElementsAreArray(bytes("8006 0083 0004 1234")));
    std::vector<std::uint8_t> pending(12);
    EXPECT_EQ(write_pending_answer(0x1234, 500, pending), 12u);
    EXPECT_THAT(pending, ElementsAreArray(bytes("0000 0089 0004 1234 0000 01f4")));
    const auto back = read_answer_header(bytes("0000 00c1 0000 0007"));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->code, kEvent + 1);
    EXPECT_FALSE(read_answer_header(bytes("0000 00c1 0004 0007")));  // shorter than it says
}

TEST(Gvcp, ResendsHaveTwoForms) {
    const auto brief = read_resend(bytes("0000 0007 ff000003 ff000005"), false);
    ASSERT_TRUE(brief);
    EXPECT_EQ(brief->block, 7u);
    EXPECT_EQ(brief->first_packet, 3u);  // 24 bits
    EXPECT_EQ(brief->last_packet, 5u);
    const auto extended = read_resend(bytes("0000 0000 01000003 01000005 0000000100000002"), true);
    ASSERT_TRUE(extended);
    EXPECT_EQ(extended->block, 0x100000002u);
    EXPECT_EQ(extended->first_packet, 0x01000003u);
    EXPECT_TRUE(extended->extended);
    EXPECT_FALSE(read_resend(bytes("0000 0007 00000005 00000003"), false));  // backwards
    EXPECT_FALSE(read_resend(bytes("0000 0000 00000003 00000005"), false));  // no block has id 0
    EXPECT_FALSE(read_resend(bytes("0000 0007 00000003 00000005"), true));   // too short
}

TEST(Gvcp, ForceIpNamesTheDeviceAndItsAddress) {
    std::vector<std::uint8_t> payload(56);
    const auto put = [&](std::size_t at, const std::string& hex) {
        const auto b = bytes(hex);
        std::copy(b.begin(), b.end(), payload.begin() + static_cast<std::ptrdiff_t>(at));
    };
    put(2, "020304050607");
    put(20, "c0a80102");
    put(36, "ffffff00");
    put(52, "c0a80101");
    const auto f = read_force_ip(payload);
    ASSERT_TRUE(f);
    EXPECT_EQ(f->mac, 0x020304050607u);
    EXPECT_EQ(f->ip, 0xC0A80102u);
    EXPECT_EQ(f->mask, 0xFFFFFF00u);
    EXPECT_EQ(f->gateway, 0xC0A80101u);
    payload.pop_back();
    EXPECT_FALSE(read_force_ip(payload));
}

TEST(Gvcp, ActionsMayHaveATime) {
    const auto now = read_action(bytes("00000001 00000002 00000004"), false);
    ASSERT_TRUE(now);
    EXPECT_EQ(now->group_mask, 4u);
    EXPECT_FALSE(now->at);
    const auto then = read_action(bytes("00000001 00000002 00000004 0000000200000001"), true);
    ASSERT_TRUE(then);
    EXPECT_EQ(then->at, 0x200000001u);
    EXPECT_FALSE(read_action(bytes("00000001 00000002 00000004"), true));
}

TEST(Gvcp, EventsHaveFourForms) {
    const Event event{0x9001, 0, 0x1'0005, 0x1122334455667788};
    std::vector<std::uint8_t> out(64);
    const auto written = [&](std::size_t size) {
        return std::vector<std::uint8_t>(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(size));
    };
    EXPECT_THAT(written(write_event(event, false, true, 9, {}, out)),
                ElementsAreArray(bytes("42 01 00c0 0010 0009 0000 9001 0000 0005 1122334455667788")));
    EXPECT_THAT(written(write_event(event, true, false, 9, {}, out)),
                ElementsAreArray(
                    bytes("42 10 00c0 0018 0009 0018 9001 0000 0000 0000000000010005 1122334455667788")));
    const auto data = bytes("aabbccdd");
    EXPECT_THAT(
        written(write_event(event, false, true, 9, data, out)),
        ElementsAreArray(bytes("42 01 00c2 0014 0009 0000 9001 0000 0005 1122334455667788 aabbccdd")));
    EXPECT_THAT(written(write_event(event, true, true, 9, data, out)),
                ElementsAreArray(bytes("42 11 00c2 001c 0009 001c 9001 0000 0000 0000000000010005 "
                                       "1122334455667788 aabbccdd")));
}

}  // namespace
}  // namespace hilcam::gvcp
