#include "io/gige/camera_clock.h"

#include <gtest/gtest.h>

#include "io/system/monotonic.h"

namespace hilcam {
namespace {

const NetInterface kNet{"lo", 0x7F000001, 0xFF000000, 0x020000000001, 65536};

TEST(CameraClock, WithSourceTaiItIsMonotonicAndSaysWhatTheMachineDoes) {
    CameraClock clock({}, kNet);
    EXPECT_EQ(clock.clock().device_ns(12'345), 12'345);
    clock.look({.state = PtpState::kDisabled, .scale = TimeScale::kMonotonic});
    EXPECT_TRUE(clock.take_notes("gige").empty());
    clock.look({.state = PtpState::kSlave,
                .servo_locked = 1,
                .offset_from_master_ns = -7,
                .scale = TimeScale::kTai});
    const auto notes = clock.take_notes("gige 127.0.0.1");
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].text,
              "gige 127.0.0.1: PTP is Slave (was Disabled), by the machine's clock; time stamps are TAI");
    EXPECT_TRUE(clock.take_notes("gige").empty());
    const ClockReport report = clock.report();
    EXPECT_EQ(report.source, "tai");
    EXPECT_EQ(report.state, "Slave");
    EXPECT_EQ(report.scale, "TAI");
    EXPECT_EQ(report.offset_from_master_ns, -7);
    EXPECT_FALSE(report.mean_path_delay_ns);
    EXPECT_EQ(report.master, "");
}

TEST(CameraClock, AFreeClockBeginsWhereItIsToldAndHasNoMaster) {
    const std::int64_t before_ns = monotonic_ns();
    CameraClock clock({.source = ClockSource::kFree, .rate = 100e-6, .offset_s = 5}, kNet);
    const std::int64_t after_ns = monotonic_ns();
    EXPECT_LE(clock.clock().device_ns(before_ns), 5'000'000'000);
    EXPECT_GE(clock.clock().device_ns(after_ns), 5'000'000'000);
    GigeEffects effects;
    clock.start(kNet, {});  // no thread: not source ptp
    clock.add_to(effects);
    EXPECT_EQ(effects.clock, &clock.clock());
    EXPECT_FALSE(effects.enable_ptp);
    EXPECT_NEAR(static_cast<double>(effects.power_up_ns()), 5e9, 1e6);
    const ClockReport report = clock.report();
    EXPECT_EQ(report.source, "free");
    EXPECT_EQ(report.state, "Disabled");
    EXPECT_EQ(report.scale, "device");
    EXPECT_FALSE(report.offset_from_master_ns || report.mean_path_delay_ns || report.rate_correction_ppm);
    clock.stop();
}

TEST(CameraClock, AReportHasWhatTheSlaveHasTakenOver) {
    CameraClock clock({.source = ClockSource::kPtp}, kNet);
    PtpDataSet d{.state = PtpState::kUncalibrated, .parent_id = 0x7A3C1FFFFE0D2B40, .mean_path_delay_ns = 9};
    clock.look(d);
    EXPECT_EQ(clock.report().master, "7a3c1f.fffe.0d2b40");
    EXPECT_FALSE(clock.report().mean_path_delay_ns);  // still its own time
    d.scale = TimeScale::kArbitrary;
    d.rate_correction = -50e-6;
    clock.look(d);
    EXPECT_EQ(clock.report().mean_path_delay_ns, 9);
    EXPECT_NEAR(clock.report().rate_correction_ppm.value_or(0), -50, 1e-9);
    EXPECT_EQ(clock.report().scale, "arbitrary");
}

}  // namespace
}  // namespace hilcam
