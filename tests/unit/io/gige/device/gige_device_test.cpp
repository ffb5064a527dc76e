#include "io/gige/device/gige_device.h"

#include <gmock/gmock.h>

#include "gige_bench.h"

namespace hilcam {
namespace {

using Bench = GigeBench;

TEST(GigeDevice, DiscoveryGivesTheFirst248Registers) {
    Bench b;
    const auto r = b.send(gvcp::kDiscovery, {}, kClient, 0xFFFF);
    EXPECT_EQ(r.status, gvcp::kSuccess);
    EXPECT_EQ(r.command, 0x0003u);
    EXPECT_EQ(r.id, 0xFFFFu);
    ASSERT_EQ(r.payload.size(), 248u);
    EXPECT_STREQ(reinterpret_cast<const char*>(r.payload.data() + 0x48), "hilcam");
    EXPECT_STREQ(reinterpret_cast<const char*>(r.payload.data() + 0xD8), "S1");
}

TEST(GigeDevice, OnlyTheControllerMayWrite) {
    Bench b;
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kAccessDenied);  // control first
    b.take_control();
    EXPECT_EQ(b.write(feature_register::kWidth, 100), gvcp::kSuccess);
    EXPECT_EQ(b.write(feature_register::kWidth, 200, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.write(bootstrap::kControl, 2, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.read(feature_register::kWidth, kOther), 100u);
    EXPECT_EQ(b.write(bootstrap::kControl, 1), gvcp::kSuccess);  // exclusive: others may not even read
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0}), kOther).status, gvcp::kAccessDenied);
    EXPECT_EQ(b.read(bootstrap::kControl, kOther), 1u);  // but who has it
    EXPECT_EQ(b.read(bootstrap::kPrimaryPort, kOther), kClient.port);
}

TEST(GigeDevice, ControlIsHandedOverToWhoHasTheKey) {
    Bench b;
    b.write(bootstrap::kControl, 2 | 4);
    b.write(bootstrap::kSwitchoverKey, 0xBEEF);
    b.write(bootstrap::kMessageAddress, kClient.ip);
    b.write(bootstrap::kMessagePort, 41000);
    b.open_stream();
    EXPECT_EQ(b.write(bootstrap::kControl, 2, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.write(bootstrap::kControl, 0xBEEEu << 16 | 2, kOther), gvcp::kAccessDenied);
    EXPECT_EQ(b.write(bootstrap::kControl, 0xBEEFu << 16, kOther), gvcp::kAccessDenied);  // asks for nothing
    EXPECT_TRUE(b.messages.empty());
    EXPECT_EQ(b.write(bootstrap::kControl, 0xBEEFu << 16 | 2, kOther), gvcp::kSuccess);
    EXPECT_EQ(b.read(bootstrap::kPrimaryPort), kOther.port);
    EXPECT_TRUE(b.device.stream_state().open);
    EXPECT_EQ(b.write(feature_register::kWidth, 64), gvcp::kAccessDenied);
    ASSERT_EQ(b.messages.size(), 1u);  // the one before is told
    EXPECT_EQ(b.messages[0].to, (Endpoint{kClient.ip, 41000}));
    EXPECT_EQ(ByteReader(std::span(b.messages[0].bytes).subspan(10)).u16(), gvcp::Event::kPrimarySwitch);
    // Without the switch-over enabled no key helps.
    EXPECT_EQ(b.write(bootstrap::kControl, 2), gvcp::kAccessDenied);
}

TEST(GigeDevice, TheHeartbeatCanBeDisabledAndStreamsMayGoOn) {
    Bench b;
    b.take_control();
    b.open_stream();
    b.write(bootstrap::kGvcpConfig, bootstrap::gvcp_config::kHeartbeatDisable);
    b.wait_ms(100'000);
    EXPECT_TRUE(b.device.controlled());
    b.write(bootstrap::kGvcpConfig, 0);
    b.write(bootstrap::kStreamConfig, bootstrap::stream_config::kUnconditional);
    b.write(feature_register::kAcquisitionStart, 1);
    b.wait_ms(3001);
    EXPECT_FALSE(b.device.controlled());
    EXPECT_TRUE(b.device.stream_state().acquiring);
}

TEST(GigeDevice, DiscoveryByBroadcastIsAnsweredToTheOwnSubnetOnly) {
    Bench b;
    const Endpoint far{0xC0A80102, 40000};
    EXPECT_EQ(b.send(gvcp::kDiscovery, {}, kClient, 0xFFFF, 1, true).status, gvcp::kSuccess);
    EXPECT_EQ(b.send(gvcp::kDiscovery, {}, far, 0xFFFF, 1, true).status, 0xFFFFu);
    EXPECT_TRUE(b.late.empty());
    EXPECT_EQ(b.send(gvcp::kDiscovery, {}, far, 0xFFFF, 0x11, true).status, 0xFFFFu);
    ASSERT_EQ(b.late.size(), 1u);  // it allows a broadcast answer
    EXPECT_EQ(b.late[0].to, (Endpoint{0xFFFFFFFF, 40000}));
    EXPECT_EQ(b.send(gvcp::kDiscovery, {}, far, 0xFFFF).status, gvcp::kSuccess);  // unicast
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0}), kClient, 0, 1, true).status, 0xFFFFu);
}

TEST(GigeDevice, ForceIpMovesTheCameraOnlyToAddressesOfThisMachine) {
    Bench b;
    const auto force = [&](std::uint64_t mac, std::uint32_t ip, std::uint32_t mask) {
        std::vector<std::uint8_t> payload(56);
        ByteWriter(std::span(payload).subspan(2)).u16(mac >> 32).u32(mac & 0xFFFFFFFF);
        ByteWriter(std::span(payload).subspan(20)).u32(ip);
        ByteWriter(std::span(payload).subspan(36)).u32(mask);
        return b.send(gvcp::kForceIp, payload, kClient, 0, 1, true).status;
    };
    const std::uint64_t mac = 0x020000000001;
    EXPECT_EQ(force(0x020000000002, 0x7F000002, 0xFF000000), 0xFFFFu);  // another camera's
    EXPECT_EQ(force(mac, 0xE0000001, 0xFF000000), gvcp::kInvalidParameter);
    EXPECT_EQ(force(mac, 0x7F000002, 0xFF00FF00), gvcp::kInvalidParameter);
    EXPECT_EQ(force(mac, 0, 0), gvcp::kSuccess);
    b.has_address = false;
    EXPECT_EQ(force(mac, 0x7F000002, 0xFF000000), gvcp::kGenericError);
    EXPECT_EQ(b.read(bootstrap::kIp), 0x7F000001u);
    b.has_address = true;
    EXPECT_EQ(force(mac, 0x7F000002, 0xFF000000), gvcp::kSuccess);
    EXPECT_EQ(b.addresses, std::vector<std::uint32_t>{0x7F000002});
    EXPECT_EQ(b.read(bootstrap::kIp), 0x7F000002u);
    b.take_control();
    EXPECT_EQ(force(mac, 0x7F000003, 0xFF000000), gvcp::kAccessDenied);
}

TEST(GigeDevice, ASilentControllerLosesTheCamera) {
    Bench b;
    b.take_control();
    b.write(bootstrap::kStreamAddress, kClient.ip);
    b.write(bootstrap::kStreamPort, 50000);
    b.write(feature_register::kAcquisitionStart, 1);
    b.wait_ms(2900);
    b.read(bootstrap::kControl);  // a heartbeat
    b.wait_ms(2900);
    EXPECT_TRUE(b.device.controlled());
    EXPECT_LE(b.device.wake_ns(), b.now_ns + GigeDevice::kLongestSleep_ns);
    b.wait_ms(101);
    EXPECT_FALSE(b.device.controlled());
    EXPECT_FALSE(b.device.stream_state().acquiring);
    EXPECT_FALSE(b.device.stream_state().open);
    EXPECT_EQ(b.write(bootstrap::kControl, 2, kOther), gvcp::kSuccess);
}

TEST(GigeDevice, ARepeatedRequestIsAnsweredButNotRunTwice) {
    Bench b;
    b.take_control();
    const auto start = Bench::words({feature_register::kAcquisitionStart, 1});
    b.send(gvcp::kWriteRegister, start, kClient, 700);
    EXPECT_EQ(b.send(gvcp::kWriteRegister, start, kClient, 700).status, gvcp::kSuccess);
    EXPECT_EQ(b.device.stream_state().epoch, 1u);
    b.send(gvcp::kWriteRegister, start, kClient, 701);
    EXPECT_EQ(b.device.stream_state().epoch, 2u);
}

TEST(GigeDevice, ConcatenatedWritesStopAtTheFirstFault) {
    Bench b;
    b.take_control();
    const auto r = b.send(gvcp::kWriteRegister,
                          Bench::words({feature_register::kWidth, 64, feature_register::kSensorWidth, 1,
                                        feature_register::kHeight, 64}));
    EXPECT_EQ(r.status, gvcp::kWriteProtect);
    EXPECT_EQ(ByteReader(std::span(r.payload).subspan(2)).u16(), 1);
    EXPECT_EQ(b.read(feature_register::kWidth), 64u);
    EXPECT_EQ(b.read(feature_register::kHeight), 480u);
}

TEST(GigeDevice, TestPacketAndResendReachTheStream) {
    Bench b;
    b.take_control();
    b.write(bootstrap::kStreamAddress, kClient.ip);
    b.write(bootstrap::kStreamPort, 50000);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 1u << 31 | 1u << 30 | 9000), gvcp::kSuccess);
    EXPECT_EQ(b.tests, std::vector<std::size_t>{9000 - 28});
    EXPECT_EQ(b.read(bootstrap::kPacketSize), 1u << 30 | 9000u);
    EXPECT_EQ(b.write(bootstrap::kPacketSize, 100), gvcp::kInvalidParameter);
    b.send(gvcp::kPacketResend, Bench::words({7, 3, 5}), Endpoint{kClient.ip, 50000}, 0, 0);
    ASSERT_EQ(b.resends.size(), 1u);
    EXPECT_EQ(b.resends[0].block, 7u);
    EXPECT_EQ(b.resends[0].last_packet, 5u);
}

// Of the receiver's machine or the controller's, others may run other programs.
TEST(GigeDevice, OnlyTheControllerAndTheReceiverAskForPacketsAgain) {
    Bench b;
    constexpr Endpoint kReceiver{0x01020304, 50000}, kGroup{0xEFC01601, 50000};
    const auto asked = [&](const Endpoint& from) {
        const std::size_t before = b.resends.size();
        const std::uint64_t foreign = b.device.foreign_resend_requests();
        b.send(gvcp::kPacketResend, Bench::words({7, 3, 5}), from, 0, 0);
        const bool taken = b.resends.size() > before;
        EXPECT_EQ(b.device.foreign_resend_requests(), foreign + !taken);
        return taken;
    };
    b.take_control();
    b.write(bootstrap::kStreamAddress, kReceiver.ip);
    b.write(bootstrap::kStreamPort, kReceiver.port);
    EXPECT_TRUE(asked(kReceiver));
    EXPECT_TRUE(asked(kClient));
    EXPECT_FALSE(asked(kOther));  // on the controller's machine
    EXPECT_FALSE(asked({kReceiver.ip, static_cast<std::uint16_t>(kReceiver.port + 1)}));  // on the receiver's
    EXPECT_FALSE(asked({kReceiver.ip + 1, kReceiver.port}));
    EXPECT_FALSE(asked({kClient.ip, kReceiver.port}));
    // Members of a group ask from wherever they are, by the port that they listen at.
    b.write(bootstrap::kStreamAddress, kGroup.ip);
    EXPECT_TRUE(asked({0x7F000009, kGroup.port}));
    EXPECT_TRUE(asked(kClient));
    EXPECT_FALSE(asked(kOther));
    EXPECT_FALSE(asked({kReceiver.ip, static_cast<std::uint16_t>(kReceiver.port + 1)}));
}

TEST(GigeDevice, UnknownCommandsGetAnHonestAnswer) {
    Bench b;
    EXPECT_EQ(b.send(0x0042, {}).status, gvcp::kNotImplemented);
    EXPECT_EQ(b.send(gvcp::kEvent, std::vector<std::uint8_t>(16)).status, gvcp::kNotImplemented);
    EXPECT_EQ(b.send(gvcp::kAction, {}).status, gvcp::kInvalidParameter);
    EXPECT_EQ(b.send(gvcp::kForceIp, {}).status, gvcp::kInvalidParameter);
    EXPECT_EQ(b.send(gvcp::kReadMemory, {1, 2, 3}).status, gvcp::kInvalidParameter);
    EXPECT_EQ(b.send(gvcp::kWriteMemory, {1, 2, 3}).status, gvcp::kInvalidParameter);
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0x5000})).status, gvcp::kInvalidAddress);
    EXPECT_EQ(b.read_memory(0x5000, 512).status, gvcp::kInvalidAddress);
    // A length that differs from the datagram's.
    EXPECT_EQ(Bench::decoded(b.raw({0x42, 1, 0, 0x80, 0, 8, 0, 5, 0, 0, 0, 0})).status, gvcp::kInvalidHeader);
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({2})).status, gvcp::kBadAlignment);
    EXPECT_EQ(b.send(gvcp::kReadRegister, Bench::words({0xFFFFFFF0})).status, gvcp::kInvalidAddress);
    EXPECT_EQ(b.send(gvcp::kReadRegister, {1, 2, 3}).status, gvcp::kInvalidParameter);
}

// 576 bytes with 28 of IP and UDP and 8 of GVCP.
TEST(GigeDevice, AMessageHasAsMuchAsADatagramHolds) {
    GigeBench b;
    b.take_control();
    const auto status = [&](std::uint16_t command, std::size_t registers, std::size_t words_each) {
        std::vector<std::uint8_t> payload(4 * words_each * registers);
        for (std::size_t i = 0; i < registers; ++i)
            ByteWriter(std::span(payload).subspan(4 * words_each * i)).u32(bootstrap::kHeartbeat);
        for (std::size_t i = 0; i < registers && words_each == 2; ++i)
            ByteWriter(std::span(payload).subspan(8 * i + 4)).u32(3000u);
        return b.send(command, payload).status;
    };
    EXPECT_EQ(status(gvcp::kReadRegister, 135, 1), gvcp::kSuccess);
    EXPECT_EQ(status(gvcp::kReadRegister, 136, 1), gvcp::kInvalidParameter);
    EXPECT_EQ(status(gvcp::kWriteRegister, 67, 2), gvcp::kSuccess);
    EXPECT_EQ(status(gvcp::kWriteRegister, 68, 2), gvcp::kInvalidParameter);
}

TEST(GigeDevice, DamagedDatagramsNeverBreakIt) {
    Bench b;
    b.take_control();
    std::uint32_t state = 99;
    const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
    const std::uint16_t commands[] = {2, 4, 0x40, 0x80, 0x82, 0x84, 0x86, 0xC0, 0x100};
    std::vector<std::uint8_t> out(gvcp::kMaxDatagramBytes);
    for (int i = 0; i < 200000; ++i) {
        std::vector<std::uint8_t> bytes(8 + next() % 560);
        for (std::uint8_t& byte : bytes) byte = next() % 2 ? static_cast<std::uint8_t>(next()) : 0;
        ByteWriter(bytes)
            .u8(0x42)
            .u8(next() & 0xFF)
            .u16(commands[next() % 9])
            .u16(bytes.size() - 8)
            .u16(next() % 65535 + 1);
        if (bytes.size() >= 12 && next() % 2)
            ByteWriter(std::span(bytes).subspan(8)).u32(0xA000 + next() % 0x120 / 4 * 4);
        if (next() % 10 == 0) bytes.resize(next() % bytes.size());
        ASSERT_LE(b.device.handle(bytes, next() % 2 ? kClient : kOther, i * 1000, out), out.size());
        const GigeStreamState& s = b.device.stream_state();
        ASSERT_LE(s.width + s.offset_x, 640u);
        ASSERT_LE(s.height + s.offset_y, 480u);
        ASSERT_GE(s.packet_bytes, 576u);
    }
}

}  // namespace
}  // namespace hilcam
