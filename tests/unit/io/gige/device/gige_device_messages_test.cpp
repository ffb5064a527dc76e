// Events, actions, repeated requests and faults of the control channel.

#include <gmock/gmock.h>

#include "gige_bench.h"
#include "io/gige/device/gige_messages.h"

namespace hilcam {
namespace {

namespace b = bootstrap;
namespace reg = feature_register;

constexpr Endpoint kMessageSocket{0x7F000001, 41000};

void open_messages(GigeBench& bench, std::uint32_t timeout_ms, std::uint32_t retries) {
    bench.take_control();
    bench.write(b::kMessageAddress, kMessageSocket.ip);
    bench.write(b::kMessagePort, kMessageSocket.port);
    bench.write(b::kMessageTimeout, timeout_ms);
    bench.write(b::kMessageRetries, retries);
    bench.write(reg::kEventSelector, 0);  // ExposureStart
    bench.write(reg::kEventNotification, 1);
}
std::vector<std::uint8_t> acknowledgement(const GigeBench::Sent& event) {
    std::vector<std::uint8_t> bytes(8);
    ByteReader in(event.bytes);
    in.skip(2);
    const unsigned code = in.u16() + 1u;
    in.u16();
    ByteWriter(bytes).u16(0).u16(code).u16(0).u16(in.u16());
    return bytes;
}

TEST(GigeMessages, AnExposureBecomesEventData) {
    GigeBench bench;
    open_messages(bench, 0, 0);
    bench.device.on_event({CameraEvent::Kind::kExposureStart, 42, 123}, 7, bench.now_ns);
    bench.device.on_event({CameraEvent::Kind::kExposureEnd, 42, 124}, 7, bench.now_ns);  // not wanted
    ASSERT_EQ(bench.messages.size(), 1u);
    EXPECT_EQ(bench.messages[0].to, kMessageSocket);
    ByteReader in(bench.messages[0].bytes);
    EXPECT_EQ(in.u32(), 0x420000C2u);  // EVENTDATA, no acknowledgement asked for
    EXPECT_EQ(in.u16(), 16 + kEventDataBytes);
    in.u16();
    EXPECT_EQ(in.u16(), 0);
    EXPECT_EQ(in.u16(), kGigeEvents[0].id);
    EXPECT_EQ(in.u16(), 0);  // stream channel
    EXPECT_EQ(in.u16(), 7);  // block
    EXPECT_EQ(in.u64(), 123u);
    EXPECT_EQ(in.u64(), 42u);
    EXPECT_EQ(in.u64(), 123u);
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(in.left(), 0u);
    // With 64-bit ids.
    bench.write(b::kGvspConfig, b::kExtendedIds);
    bench.device.on_event({CameraEvent::Kind::kExposureStart, 43, 200}, 1ull << 40, bench.now_ns);
    ASSERT_EQ(bench.messages.size(), 2u);
    EXPECT_EQ(bench.messages[1].bytes[1], 0x10);
    EXPECT_EQ(bench.messages[1].bytes.size(), 8 + 24 + kEventDataBytes);
}

TEST(GigeMessages, UnacknowledgedEventsAreRepeatedInOrder) {
    GigeBench bench;
    open_messages(bench, 100, 2);
    bench.device.on_event({CameraEvent::Kind::kExposureStart, 1, 10}, 1, bench.now_ns);
    bench.device.on_event({CameraEvent::Kind::kExposureStart, 2, 20}, 2, bench.now_ns);
    ASSERT_EQ(bench.messages.size(), 1u);  // the second waits for the first
    EXPECT_EQ(bench.messages[0].bytes[1], 0x01);
    bench.wait_ms(99);
    EXPECT_EQ(bench.messages.size(), 1u);
    EXPECT_EQ(bench.device.wake_ns(), bench.now_ns + 1'000'000);
    bench.wait_ms(1);
    ASSERT_EQ(bench.messages.size(), 2u);
    EXPECT_EQ(bench.messages[1].bytes, bench.messages[0].bytes);
    bench.raw(acknowledgement(bench.messages[0]), kOther);  // not from there
    EXPECT_EQ(bench.messages.size(), 2u);
    EXPECT_TRUE(bench.raw(acknowledgement(bench.messages[0]), kMessageSocket).empty());
    ASSERT_EQ(bench.messages.size(), 3u);
    EXPECT_NE(bench.messages[2].bytes, bench.messages[0].bytes);
    for (int i = 0; i < 5; ++i) bench.wait_ms(100);
    EXPECT_EQ(bench.messages.size(), 5u);  // two repetitions, then it is given up
    EXPECT_EQ(bench.read64(reg::kStatistics + 8 * 7), 1u);
}

TEST(GigeActions, FireWhenKeysAndMaskFit) {
    GigeBench bench;
    bench.take_control();
    bench.write(b::kActionDeviceKey, 11);
    bench.write(b::kActionGroupKey, 22);
    bench.write(b::kActionGroupMask, 6);
    const auto act = [&](std::uint32_t device, std::uint32_t group, std::uint32_t mask) {
        return bench.send(gvcp::kAction, GigeBench::words({device, group, mask}), kOther, 0, 1, true).status;
    };
    EXPECT_EQ(act(12, 22, 2), 0xFFFFu);  // not for this camera: silence
    EXPECT_EQ(act(11, 23, 2), 0xFFFFu);
    EXPECT_EQ(act(11, 22, 1), 0xFFFFu);
    EXPECT_TRUE(bench.camera.triggers.empty());
    EXPECT_EQ(act(11, 22, 3), gvcp::kSuccess);
    ASSERT_EQ(bench.camera.triggers.size(), 1u);
    EXPECT_EQ(bench.camera.triggers[0].source, TriggerSource::kAction1);
    bench.write(b::kControl, 0);
    EXPECT_EQ(act(11, 22, 3), gvcp::kAccessDenied);  // nobody has control
    bench.take_control();
    bench.write(b::kGvcpConfig, b::gvcp_config::kUnconditionalAction);
    bench.write(b::kControl, 0);
    EXPECT_EQ(act(11, 22, 3), gvcp::kSuccess);
}

TEST(GigeActions, CanBeScheduled) {
    GigeBench bench;
    open_messages(bench, 0, 0);
    bench.write(b::kActionGroupMask, 1);
    bench.write(b::kGvcpConfig, b::gvcp_config::kExtendedStatus20);
    const auto act_at = [&](std::int64_t at_ns) {
        std::vector<std::uint8_t> payload(20);
        ByteWriter(payload).u32(0).u32(0).u32(1).u64(static_cast<std::uint64_t>(at_ns));
        return bench.send(gvcp::kAction, payload, kOther, 0, 0x81, true).status;
    };
    const std::int64_t due_ns = bench.now_ns + 100'000'000;
    EXPECT_EQ(act_at(due_ns), gvcp::kSuccess);
    EXPECT_TRUE(bench.camera.triggers.empty());
    bench.wait_ms(85);  // shortly before, with its exact time
    ASSERT_EQ(bench.camera.triggers.size(), 1u);
    EXPECT_EQ(bench.camera.triggers[0].at_monotonic_ns, due_ns);
    EXPECT_EQ(act_at(bench.now_ns - 1), gvcp::kActionLate);
    EXPECT_EQ(bench.camera.triggers.size(), 1u);
    ASSERT_EQ(bench.messages.size(), 1u);
    EXPECT_EQ(ByteReader(std::span(bench.messages[0].bytes).subspan(10)).u16(), gvcp::Event::kActionLate);
    for (int i = 0; i < 16; ++i) EXPECT_EQ(act_at(bench.now_ns + 1'000'000'000), gvcp::kSuccess);
    EXPECT_EQ(act_at(bench.now_ns + 1'000'000'000), gvcp::kOverflow);
    bench.write(b::kGvcpConfig, 0);  // a client that does not know those codes
    EXPECT_EQ(act_at(0), gvcp::kGenericError);
}

TEST(GigeControlFaults, SlowAnswersAreAnnouncedAndRepeatedRequestsNotRunTwice) {
    GigeBench bench;
    bench.take_control();
    bench.write(b::kGvcpConfig, b::gvcp_config::kPendingAnswer);
    bench.faults.order({.kind = FaultKind::kControlSlow, .value = 300});
    const auto start = GigeBench::words({reg::kAcquisitionStart, 1});
    const auto pending = bench.send(gvcp::kWriteRegister, start, kClient, 900);
    EXPECT_EQ(pending.command, gvcp::kPendingAnswer);
    EXPECT_EQ(pending.id, 900u);
    EXPECT_GE(ByteReader(std::span(pending.payload).subspan(2)).u16(), 300);
    bench.wait_ms(200);
    EXPECT_EQ(bench.send(gvcp::kWriteRegister, start, kClient, 900).command, gvcp::kPendingAnswer);
    EXPECT_TRUE(bench.late.empty());
    bench.wait_ms(100);
    ASSERT_EQ(bench.late.size(), 1u);
    EXPECT_EQ(GigeBench::decoded(bench.late[0].bytes).status, gvcp::kSuccess);
    EXPECT_EQ(GigeBench::decoded(bench.late[0].bytes).id, 900u);
    bench.faults.clear_all();
    EXPECT_EQ(bench.send(gvcp::kWriteRegister, start, kClient, 900).status, gvcp::kSuccess);
    EXPECT_EQ(bench.device.stream_state().epoch, 1u);
    // Who has not enabled it hears nothing until then.
    bench.write(b::kGvcpConfig, 0);
    bench.faults.order({.kind = FaultKind::kControlSlow, .value = 300});
    EXPECT_EQ(bench.send(gvcp::kReadRegister, GigeBench::words({0})).status, 0xFFFFu);
    bench.wait_ms(300);
    EXPECT_EQ(bench.late.size(), 2u);
}

TEST(GigeControlFaults, SilenceBusyDeniedAndALostLink) {
    const struct {
        FaultKind kind;
        unsigned status, discovery;
    } cases[] = {{FaultKind::kControlSilence, 0xFFFF, 0xFFFF},
                 {FaultKind::kControlBusy, gvcp::kBusy, gvcp::kSuccess},
                 {FaultKind::kControlDenied, gvcp::kAccessDenied, gvcp::kSuccess},
                 {FaultKind::kLinkDown, 0xFFFF, 0xFFFF}};
    for (const auto& c : cases) {
        GigeBench bench;
        bench.take_control();
        bench.faults.order({.kind = c.kind});
        EXPECT_EQ(bench.write(reg::kWidth, 64), c.status) << name_of(c.kind);
        EXPECT_EQ(bench.send(gvcp::kDiscovery, {}).status, c.discovery);
        EXPECT_GE(bench.faults.strikes_of(c.kind), 1u);
        bench.faults.clear_all();
        EXPECT_EQ(bench.read(reg::kWidth), 640u);  // it was not run
        EXPECT_EQ(bench.write(reg::kWidth, 64), gvcp::kSuccess);
    }
}

TEST(GigeControlFaults, NothingLeavesOverALostLink) {
    GigeBench bench;
    open_messages(bench, 100, 10);
    bench.faults.order({.kind = FaultKind::kControlSlow, .value = 100});
    bench.read(b::kControl);
    bench.faults.order({.kind = FaultKind::kLinkDown});
    bench.device.on_event({CameraEvent::Kind::kExposureStart, 1, 10}, 1, bench.now_ns);
    bench.wait_ms(150);
    EXPECT_TRUE(bench.messages.empty());
    EXPECT_TRUE(bench.late.empty());
    bench.faults.clear_all();
    bench.wait_ms(100);
    EXPECT_EQ(bench.messages.size(), 1u);  // it is repeated still; the answer is lost
    EXPECT_TRUE(bench.late.empty());
}

TEST(GigeControlFaults, AStruckRequestMayPassWhenRepeated) {
    GigeBench bench;
    bench.take_control();
    bench.faults.order({.kind = FaultKind::kControlSilence, .rate = 0.5});
    int answered = 0;
    for (std::uint16_t id = 1000; id < 1100; ++id)
        for (int attempt = 0; attempt < 20; ++attempt)
            if (bench.send(gvcp::kReadRegister, GigeBench::words({0}), kClient, id).status == 0) {
                ++answered;
                break;
            }
    EXPECT_EQ(answered, 100);  // each fails with 2^-20
}

TEST(GigeControlFaults, ADeafHeartbeatLosesControl) {
    GigeBench bench;
    bench.take_control();
    bench.faults.order({.kind = FaultKind::kHeartbeatIgnored});
    for (int i = 0; i < 31; ++i) {
        bench.wait_ms(100);
        bench.read(b::kControl);
    }
    EXPECT_FALSE(bench.device.controlled());
}

TEST(GigeControlFaults, TheDeviceIsResetAndMovedOnce) {
    GigeBench bench;
    bench.take_control();
    bench.faults.order({.kind = FaultKind::kDeviceReset});
    bench.wait_ms(50);
    bench.wait_ms(50);
    EXPECT_EQ(bench.resets, 1);
    EXPECT_FALSE(bench.device.controlled());
    bench.faults.order({.kind = FaultKind::kIpChange, .value = 5});
    bench.wait_ms(50);
    bench.wait_ms(50);
    EXPECT_EQ(bench.addresses, std::vector<std::uint32_t>{0x7F000006});
}

TEST(GigeControlFaults, LongTestPacketsGetLost) {
    GigeBench bench;
    bench.take_control();
    bench.open_stream();
    bench.faults.order({.kind = FaultKind::kTestPacketLimit, .value = 1500});
    bench.write(b::kPacketSize, 1u << 31 | 1504);
    EXPECT_TRUE(bench.tests.empty());
    bench.write(b::kPacketSize, 1u << 31 | 1500);
    EXPECT_EQ(bench.tests.size(), 1u);
    EXPECT_EQ(bench.faults.strikes_of(FaultKind::kTestPacketLimit), 1u);
}

TEST(GigeControlFaults, AreFeaturesThemselves) {
    GigeBench bench;
    bench.take_control();
    bench.write(reg::kFaultSelector, 3);  // PacketDelay
    EXPECT_EQ(bench.write_real(reg::kFaultRate, 0.25), gvcp::kSuccess);
    EXPECT_EQ(bench.write_real(reg::kFaultRate, 1.5), gvcp::kInvalidParameter);
    EXPECT_EQ(bench.write_real(reg::kFaultValue, 20'000), gvcp::kSuccess);
    EXPECT_EQ(bench.write(reg::kFaultEnable, 1), gvcp::kInvalidParameter);  // at most 10 s
    bench.write_real(reg::kFaultValue, 20);
    bench.write64(reg::kFaultFromFrame, 100);
    EXPECT_EQ(bench.read(reg::kFaultActive), 0u);
    EXPECT_EQ(bench.write(reg::kFaultEnable, 1), gvcp::kSuccess);
    EXPECT_EQ(bench.read(reg::kFaultActive), 1u);
    const auto order = bench.faults.order_of(FaultKind::kPacketDelay);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->rate, 0.25);
    EXPECT_EQ(order->value, 20);
    EXPECT_EQ(order->from_frame, 100u);
    bench.faults.order({.kind = FaultKind::kPacketDelay, .value = 7});  // another party's
    EXPECT_EQ(bench.read_real(reg::kFaultValue), 7);
    bench.faults.strikes(FaultKind::kPacketDelay, 1);
    EXPECT_EQ(bench.read64(reg::kFaultCount), 1u);
    bench.write(reg::kFaultClear, 1);
    EXPECT_FALSE(bench.faults.order_of(FaultKind::kPacketDelay));
}

TEST(GigeControlFaults, SoManyFramesAtOnceAreSoAgainWhenEnabledAgain) {
    GigeBench bench;
    bench.take_control();
    bench.write(reg::kFaultSelector, 3);  // PacketDelay
    bench.write_real(reg::kFaultRate, 1);
    bench.write64(reg::kFaultFrames, 5);
    for (const std::uint64_t begun : {40u, 90u}) {
        bench.faults.begin(begun);
        EXPECT_EQ(bench.write(reg::kFaultEnable, 1), gvcp::kSuccess);
        EXPECT_EQ(bench.faults.order_of(FaultKind::kPacketDelay)->from_frame, begun + 1);
        EXPECT_EQ(bench.read64(reg::kFaultFromFrame), 0u);
    }
}

}  // namespace
}  // namespace hilcam
