#include "emulator/send/command_words.h"

#include <gmock/gmock.h>

#include "emulator/send/send_watch.h"
#include "io/contract/frame_flags.h"
#include "render/vocabulary/attitude.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string error_of(const std::string& script) {
    try {
        parse_script(script, "a.txt");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

// The same attitude in each form: Basilisk's own test values
// (tests/unit/render/vocabulary/attitude_test.cpp).
TEST(CommandScript, APoseTakesAnAttitudeInAnyForm) {
    for (const char* form : {"--mrp 0.2 -0.25 0.3",
                             "--dcm 0.1420874 0.4001248 0.9053791 -0.9626905 0.2686647 0.0323475 -0.2303003 "
                             "-0.8761960 0.4233702",
                             "--euler-deg 70.449659 -64.874389 4.369185 --sequence 321"}) {
        const auto lines = parse_script(std::string("pose --position-m 0 0 0 ") + form + "\n", "a.txt");
        const Quat q = std::get<PoseCommand>(lines.at(0).command).motion.pose.world_from_body;
        const double sign = q.w < 0 ? -1 : 1;
        EXPECT_NEAR(sign * q.w, 0.6771488, 1e-6) << form;
        EXPECT_NEAR(sign * q.y, -0.4192872, 1e-6) << form;
    }
    const auto lines = parse_script("pose --position-m 0 0 0 --radec-deg 10 20 30\n", "a.txt");
    const RaDecRoll at = radec_of(std::get<PoseCommand>(lines.at(0).command).motion.pose.world_from_body);
    EXPECT_NEAR(at.right_ascension_rad, 10 * kDegree_rad, 1e-12);
    EXPECT_NEAR(at.declination_rad, 20 * kDegree_rad, 1e-12);
    EXPECT_NEAR(at.roll_rad, 30 * kDegree_rad, 1e-12);
    EXPECT_THAT(error_of("pose --position-m 0 0 0 --mrp 0 0 1 --attitude 1 0 0 0\n"), HasSubstr("excludes"));
    EXPECT_THAT(error_of("pose --position-m 0 0 0 --euler-deg 0 0 1\n"), HasSubstr("requires --sequence"));
    EXPECT_THAT(error_of("pose --position-m 0 0 0 --dcm 1 0 0 0 1 0 0 0 2\n"),
                HasSubstr("--dcm: found a matrix that is off a rotation by 3"));
    EXPECT_THAT(error_of("pose --position-m 0 0 0 --radec-deg 0 91 0\n"), HasSubstr("accepted: -90 to 90"));
}

TEST(CommandScript, LinesHaveTimesAndCommands) {
    const auto lines = parse_script(
        "# a comment\n"
        "ping\n"
        "\n"
        "+0.5 pose --object 2 --position-m 1 2 3 --attitude 0 1 0 0  # another\n"
        "@2 fault packet_drop --rate 0.25 --frames 9\n"
        "+0.25 fault clear\n"
        "expose --frames 3\n"
        "mode triggered --burst-frames 4\n"
        "settings --gain-db 6\n"
        "joint --object 1 --angle-deg 180 --at-utc 2026-01-01T00:00:00Z\n"
        "stop\n"
        "clock --scale 0.1\n"
        "clock step --seconds 0.5\n"
        "clock pause\n"
        "clock\n"
        "lamp on --lamp 2 --level 0.25 --at-utc 2026-01-01T00:00:00Z\n"
        "lamp off\n",
        "a.txt");
    ASSERT_EQ(lines.size(), 15u);
    EXPECT_EQ(lines[0].at_s, 0);
    EXPECT_EQ(lines[0].number, 2u);
    const auto& pose = std::get<PoseCommand>(lines[1].command);
    EXPECT_EQ(lines[1].at_s, 0.5);
    EXPECT_EQ(pose.object, 2);
    EXPECT_EQ(pose.motion.pose.position_world_m.z, 3);
    EXPECT_EQ(pose.motion.pose.world_from_body.x, 1);
    const auto& fault = std::get<FaultCommand>(lines[2].command);
    EXPECT_EQ(lines[2].at_s, 2);
    EXPECT_EQ(fault.order.kind, FaultKind::kPacketDrop);
    EXPECT_EQ(fault.order.rate, 0.25);
    EXPECT_EQ(fault.order.frames, 9u);
    EXPECT_EQ(lines[3].at_s, 2.25);
    EXPECT_TRUE(std::get<FaultCommand>(lines[3].command).clear_all);
    EXPECT_EQ(lines[4].at_s, 2.25);
    EXPECT_EQ(std::get<ExposeCommand>(lines[4].command).frames, 3);
    const auto& mode = std::get<TriggerModeCommand>(lines[5].command);
    EXPECT_TRUE(mode.triggered);
    EXPECT_EQ(mode.burst_frames, 4);
    EXPECT_EQ(std::get<SettingsCommand>(lines[6].command).gain_db, 6);
    EXPECT_FALSE(std::get<SettingsCommand>(lines[6].command).exposure_s);
    EXPECT_NEAR(std::get<JointCommand>(lines[7].command).angle_rad, 3.14159265, 1e-8);
    EXPECT_EQ(std::get<JointCommand>(lines[7].command).time, parse_utc("2026-01-01T00:00:00Z"));
    EXPECT_EQ(pose.motion.time.ns, 0);  // on arrival
    EXPECT_TRUE(std::holds_alternative<StopCommand>(lines[8].command));
    using Action = ClockCommand::Action;
    const auto clock = [&](std::size_t line) { return std::get<ClockCommand>(lines[line].command); };
    EXPECT_EQ(clock(9).action, Action::kScale);
    EXPECT_EQ(clock(9).scale, 0.1);
    EXPECT_EQ(clock(10).action, Action::kStep);
    EXPECT_EQ(clock(10).step_ns, 500'000'000);
    EXPECT_EQ(clock(11).action, Action::kPause);
    EXPECT_EQ(clock(12).action, Action::kAsk);
    const auto lamp = [&](std::size_t line) { return std::get<LampCommand>(lines[line].command); };
    EXPECT_EQ(lamp(13).lamp, 2);
    EXPECT_EQ(lamp(13).level, 0.25);
    EXPECT_EQ(lamp(13).time, parse_utc("2026-01-01T00:00:00Z"));
    EXPECT_EQ(lamp(14).lamp, 1);
    EXPECT_EQ(lamp(14).level, 0);
    EXPECT_EQ(lamp(14).time.ns, 0);
}

TEST(CommandScript, MistakesNameTheLine) {
    EXPECT_THAT(error_of("ping\nfault nonsense\n"),
                HasSubstr("a.txt:2: fault: found 'nonsense'; accepted: clear"));
    EXPECT_THAT(error_of("fault packet_delay --value -4\n"), HasSubstr("value is outside its kind's range"));
    EXPECT_THAT(error_of("@1 ping\n@0.5 ping\n"), HasSubstr("a.txt:2: its time @0.5 is before"));
    for (const char* wild : {"+x", "@-1", "@nan", "@inf", "@1e10", "+1e300"})
        EXPECT_THAT(error_of(wild + std::string(" ping\n")), HasSubstr("accepted: @SECONDS")) << wild;
    EXPECT_THAT(error_of("@9e8 ping\n+2e8 ping\n"), HasSubstr("a.txt:2: found '+2e8'"));
    EXPECT_THAT(error_of("jump\n"), HasSubstr("a.txt:1:"));
    EXPECT_THAT(error_of("+1\n"), HasSubstr("a.txt:1:"));
    EXPECT_THAT(error_of("fault list\n"), HasSubstr("a.txt:1: fault: found 'list'"));
    EXPECT_THAT(error_of("pose --position-m 1 2 3 --look-at-m 1 2 3\n"), HasSubstr("a.txt:1:"));
    EXPECT_THAT(error_of("clock step\n"), HasSubstr("'step' and --seconds go together"));
    EXPECT_THAT(error_of("clock pause --seconds 1\n"), HasSubstr("'step' and --seconds go together"));
    EXPECT_THAT(error_of("clock --scale 0\n"), HasSubstr("accepted: 0.001 to 1000"));
    EXPECT_THAT(error_of("clock faster\n"), HasSubstr("a.txt:1:"));
    EXPECT_THAT(error_of("lamp dim\n"), HasSubstr("a.txt:1:"));
    EXPECT_THAT(error_of("lamp off --level 0.5\n"), HasSubstr("'off' and --level do not go together"));
    EXPECT_THAT(error_of("lamp on --level nan\n"), HasSubstr("--level: found 'nan'; accepted: a number"));
    for (const char* wild : {"1.5", "-1"})
        EXPECT_THAT(error_of(std::string("lamp on --level ") + wild + "\n"), HasSubstr("accepted: 0 to 1"));
    EXPECT_EQ(error_of("# nothing\n\n"), "no error");
}

TEST(Watch, LinesSayWhatThePacketsDo) {
    FrameReport report;
    report.faults = kPosesStaleBit | kTimeStandsBit;
    EXPECT_THAT(text_of(report), HasSubstr("faults time_stands poses_stale"));
    report.frame = 12;
    report.latency_ns = 1'500'000;
    report.faults = bit_of(FaultKind::kImageBlack);
    EXPECT_THAT(text_of(report), StartsWith("frame 12"));
    report.camera = 2;
    EXPECT_THAT(text_of(report, true), StartsWith("camera 2 frame 12"));
    EXPECT_THAT(json_of(report), HasSubstr("\"camera\":2"));
    EXPECT_THAT(text_of(report), HasSubstr("pose to frame 1.500 ms faults image_black"));
    EXPECT_THAT(json_of(report), HasSubstr("\"faults\":[\"image_black\"]"));
    HousekeepingFigures figures;
    figures.mode = OperatingMode::kLockstep;
    EXPECT_THAT(text_of(figures), HasSubstr("camera lockstep paused"));
    figures.mode = static_cast<OperatingMode>(77);
    EXPECT_THAT(json_of(figures), HasSubstr("unknown mode"));
}

}  // namespace
}  // namespace hilcam
