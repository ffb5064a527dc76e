#include "io/gige/device/gige_clock.h"

#include <gtest/gtest.h>

#include "tests/unit/io/gige/device/gige_bench.h"

namespace hilcam {
namespace {

namespace reg = feature_register;
using bootstrap::gvcp_config::kPtpEnable;

constexpr std::int64_t kTai_ns = 1'700'000'000'000'000'000;

std::uint64_t latched_time(GigeBench& b) {
    b.write(bootstrap::kTimestampControl, 2);
    return b.read64(bootstrap::kTimestamp);
}

TEST(GigeClock, IsMonotonicUntilPtpIsEnabledWithSourceTai) {
    GigeBench b;
    b.take_control();
    EXPECT_EQ(latched_time(b), static_cast<std::uint64_t>(b.now_ns));
    EXPECT_EQ(b.device.ptp_data_set().scale, TimeScale::kMonotonic);
    b.write(bootstrap::kTimestampControl, 1);
    EXPECT_EQ(b.device.ptp_data_set().scale, TimeScale::kDevice);
    b.wait_ms(5);
    EXPECT_EQ(latched_time(b), 5'000'000u);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 3u);  // Disabled
    b.system_clock = {.tai_minus_monotonic_ns = kTai_ns};
    b.write(bootstrap::kGvcpConfig, kPtpEnable);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 4u);  // Listening: nothing keeps the clock
    b.system_clock.synchronised = true;
    b.wait_ms(1);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 8u);  // Uncalibrated: UTC, not TAI
    EXPECT_EQ(b.device.ptp_data_set().scale, TimeScale::kUtc);
    b.system_clock.tai_offset_known = true;
    b.wait_ms(1);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 9u);                              // Slave
    EXPECT_EQ(b.write(bootstrap::kTimestampControl, 1), gvcp::kAccessDenied);  // TAI is not ours to reset
    EXPECT_EQ(latched_time(b), static_cast<std::uint64_t>(kTai_ns + b.now_ns));
    EXPECT_EQ(b.device.ptp_data_set().steps, 0u);
    b.system_clock.tai_minus_monotonic_ns += 1'000'000'000;  // the machine's clock was set
    b.wait_ms(1);
    EXPECT_EQ(b.device.ptp_data_set().steps, 1u);
    EXPECT_EQ(latched_time(b), static_cast<std::uint64_t>(kTai_ns + 1'000'000'000 + b.now_ns));
    b.write(bootstrap::kGvcpConfig, 0);
    EXPECT_EQ(latched_time(b), static_cast<std::uint64_t>(b.now_ns));
}

TEST(GigeClock, WithSourceTaiALatchHasWhatTheKernelKnows) {
    GigeBench b;
    b.take_control();
    b.system_clock = {kTai_ns, true, true, -1'234};
    b.write(bootstrap::kGvcpConfig, kPtpEnable);
    EXPECT_EQ(b.write(reg::kPtpDataSetLatch, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kPtpLatchedStatus), 9u);
    EXPECT_EQ(b.read(reg::kPtpServoStatus), 1u);
    EXPECT_EQ(static_cast<std::int64_t>(b.read64(reg::kPtpOffset_ns)), -1'234);
    EXPECT_EQ(b.read64(reg::kPtpClockId), 0x020000FFFE000001u);  // of the MAC address
    EXPECT_EQ(b.read64(reg::kPtpParentId), 0u);
    EXPECT_EQ(b.read(reg::kPtpTimeScale), 4u);  // TAI
}

TEST(GigeClock, LatchedValuesAreOfOneInstant) {
    GigeBench b(nullptr, {}, ClockSource::kPtp);
    b.take_control();
    b.write(bootstrap::kGvcpConfig, kPtpEnable);
    b.ptp_set = {.state = PtpState::kSlave,
                 .servo_locked = 1,
                 .parent_id = 0xFE11'22FF'FE33'4455,
                 .grandmaster_id = 7,
                 .offset_from_master_ns = -987'654'321'012,
                 .mean_path_delay_ns = 12'345,
                 .scale = TimeScale::kArbitrary,
                 .utc_offset_s = -3,
                 .steps = 2};
    EXPECT_EQ(b.read(reg::kPtpLatchedStatus), 3u);  // not latched yet
    b.write(reg::kPtpDataSetLatch, 1);
    const PtpDataSet then = b.ptp_set;
    b.ptp_set = {};
    EXPECT_EQ(b.read(reg::kPtpLatchedStatus), 9u);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 3u);  // the live one
    EXPECT_EQ(b.read(reg::kPtpServoStatus), 1u);
    EXPECT_EQ(static_cast<std::int64_t>(b.read64(reg::kPtpOffset_ns)), then.offset_from_master_ns);
    EXPECT_EQ(b.read64(reg::kPtpDelay_ns), 12'345u);
    EXPECT_EQ(b.read64(reg::kPtpParentId), then.parent_id);
    EXPECT_EQ(b.read64(reg::kPtpGrandmasterId), 7u);
    EXPECT_EQ(b.read(reg::kPtpTimeScale), 2u);
    EXPECT_EQ(static_cast<std::int32_t>(b.read(reg::kPtpUtcOffset_s)), -3);
    EXPECT_EQ(b.read(reg::kPtpSteps), 2u);
}

TEST(GigeClock, PtpEnableSwitchesTheSlave) {
    GigeBench b(nullptr, {}, ClockSource::kPtp);
    b.take_control();
    EXPECT_TRUE(b.ptp_orders.empty());
    b.ptp_set.state = PtpState::kListening;
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 3u);
    b.write(bootstrap::kGvcpConfig, kPtpEnable);
    EXPECT_EQ(b.ptp_orders, std::vector<bool>{true});
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 4u);
    EXPECT_EQ(b.write(bootstrap::kTimestampControl, 1), gvcp::kAccessDenied);
    b.write(reg::kDeviceReset, 1);
    EXPECT_EQ(b.ptp_orders, (std::vector<bool>{true, false}));
    EXPECT_EQ(b.clock.device_ns(b.now_ns), 0);  // as after power-up
}

TEST(GigeClock, PtpMayBeOnFromThePowerUp) {
    GigeBench b(nullptr, {}, ClockSource::kPtp, true);
    EXPECT_EQ(b.ptp_orders, std::vector<bool>{true});
    EXPECT_EQ(b.read(bootstrap::kGvcpConfig), kPtpEnable);
    b.take_control();
    b.write(reg::kDeviceReset, 1);
    EXPECT_EQ(b.ptp_orders, (std::vector<bool>{true, false, true}));
}

TEST(GigeClock, AFreeClockHasNoPtp) {
    GigeBench b(nullptr, {}, ClockSource::kFree);
    b.take_control();
    EXPECT_EQ(b.read(bootstrap::kGvcpCapability) & bootstrap::gvcp_can::kPtp, 0u);
    EXPECT_EQ(b.write(bootstrap::kGvcpConfig, kPtpEnable), gvcp::kInvalidParameter);
    EXPECT_EQ(b.read(bootstrap::kPtpStatus), 3u);
    EXPECT_EQ(latched_time(b), 0u);
    b.wait_ms(10'000);
    b.take_control();                             // which has ended: no heartbeat
    EXPECT_EQ(latched_time(b), 10'001'000'000u);  // 100 ppm
    b.write(bootstrap::kTimestampControl, 1);
    EXPECT_EQ(latched_time(b), 0u);
}

TEST(GigeClock, AnActionComesAtItsTimeByAClockOfAnotherRate) {
    GigeBench b(nullptr, {}, ClockSource::kPtp);
    b.take_control();
    b.write(bootstrap::kActionDeviceKey, 1);
    b.write(bootstrap::kActionGroupKey, 2);
    b.write(bootstrap::kActionGroupMask, 4);
    std::vector<std::uint8_t> payload(20);
    // At 20 s of a clock that began at 0, 1 s after CLOCK_MONOTONIC's 0, and gains 100 ppm.
    ByteWriter(payload).u32(1).u32(2).u32(4).u64(20'000'000'000);
    ASSERT_EQ(b.send(gvcp::kAction, payload, kClient, 0, 0x81).status, gvcp::kSuccess);
    const std::int64_t due_ns = 1'000'000'000 + 19'998'000'200;  // 20 s / 1.0001
    b.now_ns = due_ns - 30'000'000;
    b.device.tick(b.now_ns);
    EXPECT_TRUE(b.camera.triggers.empty());
    EXPECT_NEAR(static_cast<double>(b.device.wake_ns() - (due_ns - 20'000'000)), 0, 1);
    b.now_ns = due_ns - 19'000'000;
    b.device.tick(b.now_ns);
    ASSERT_EQ(b.camera.triggers.size(), 1u);
    EXPECT_NEAR(static_cast<double>(b.camera.triggers[0].at_monotonic_ns - due_ns), 0, 1);
}

TEST(GigeClock, EventsHaveTheDevicesTime) {
    GigeBench b(nullptr, {}, ClockSource::kPtp);
    b.take_control();
    b.write(bootstrap::kMessageAddress, kClient.ip);
    b.write(bootstrap::kMessagePort, 50'001);
    b.write(reg::kEventSelector, 0);
    b.write(reg::kEventNotification, 1);
    b.device.on_event({CameraEvent::Kind::kExposureStart, 1, 11'000'000'000}, 0, b.now_ns);
    ASSERT_EQ(b.messages.size(), 1u);
    // 10 s after the clock's begin, and 100 ppm.
    ByteReader in(std::span(b.messages[0].bytes).subspan(b.messages[0].bytes.size() - 8));
    EXPECT_EQ(in.u64(), 10'001'000'000u);
}

TEST(GigeClock, TheKernelsClocksAreRead) {
    const GigeSystemClock clock = read_system_clock();
    // CLOCK_TAI counts since 1970, CLOCK_MONOTONIC since the machine's start.
    EXPECT_GT(clock.tai_minus_monotonic_ns, 1'600'000'000'000'000'000);
}

}  // namespace
}  // namespace hilcam
