// Lamps from the scenario file and from commands to the frames.

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/run/event_director.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// --- a lamp's switches

TEST(LampSwitches, HoldFromTheirTimeOnInAnyOrder) {
    LampSwitches lamp(0.25);
    EXPECT_EQ(lamp.at({-5}), 0.25);
    lamp.insert({{30}, 0});
    lamp.insert({{10}, 1});  // late, but before
    EXPECT_EQ(lamp.at({9}), 0.25);
    EXPECT_EQ(lamp.at({10}), 1);
    EXPECT_EQ(lamp.at({29}), 1);
    EXPECT_EQ(lamp.at({30}), 0);
    EXPECT_EQ(lamp.at({1'000'000}), 0);
    lamp.insert({{10}, 0.5});  // a correction of the same instant
    EXPECT_EQ(lamp.at({10}), 0.5);
}

TEST(LampSwitches, MeansAreByTheShareOfTheTime) {
    LampSwitches lamp(1);
    EXPECT_EQ(lamp.mean({0}, {100}), 1);
    lamp.insert({{20}, 0});
    lamp.insert({{60}, 0.5});
    EXPECT_DOUBLE_EQ(lamp.mean({0}, {100}), 0.2 * 1 + 0.4 * 0.5);
    EXPECT_DOUBLE_EQ(lamp.mean({10}, {30}), 0.5);
    EXPECT_EQ(lamp.mean({20}, {60}), 0);
    EXPECT_EQ(lamp.mean({60}, {90}), 0.5);
    EXPECT_EQ(lamp.mean({60}, {60}), 0.5);  // no time at all: that instant
    // Tags may be any number.
    lamp.insert({{std::numeric_limits<std::int64_t>::max()}, 1});
    lamp.insert({{std::numeric_limits<std::int64_t>::min()}, 1});
    EXPECT_DOUBLE_EQ(lamp.mean({0}, {100}), 0.2 * 1 + 0.4 * 0.5);
}

TEST(LampSwitches, TheNewestEightAreKeptAndWhatWasBeforeThem) {
    LampSwitches lamp(0);
    for (int i = 1; i <= 12; ++i) lamp.insert({{i * 10}, i / 16.0});
    EXPECT_EQ(lamp.at({125}), 12 / 16.0);
    EXPECT_EQ(lamp.at({50}), 5 / 16.0);
    EXPECT_EQ(lamp.at({49}), 4 / 16.0);  // of the newest that is not kept any more
    lamp.insert({{5}, 1});               // older than all that are kept: no effect
    EXPECT_EQ(lamp.at({49}), 4 / 16.0);
    lamp.begin_anew();
    EXPECT_EQ(lamp.at({5}), 12 / 16.0);  // as it was at last
    lamp.insert({{7}, 0});
    EXPECT_EQ(lamp.at({6}), 12 / 16.0);
    EXPECT_EQ(lamp.at({1000}), 0);
}

// --- in the world

Motion standing(Vec3d position_m, Quat attitude = {}) { return {{0}, {position_m, attitude}, {}, {}}; }

TEST(WorldLamps, RideOnTheirThings) {
    const Quat quarter = from_rotation_vector({0, 0, kPi / 2});
    Motion moving = standing({10, 0, 0}, quarter);
    moving.velocity_world_m_s = {0, 0, 2};
    const Motion motions[2] = {standing({1, 2, 3}), moving};
    const Joint joint{0, {0, 1, 0}, {0, 1, 0}, kPi / 2, 0};
    const LampMount mounts[3] = {
        {0, {0.1, 0, 0}, {0, 0, 1}, 1}, {1, {1, 0, 0}, {1, 0, 0}, 0.5}, {2, {0, 1, 1}, {0, 0, 1}, 0}};
    WorldState world(motions, {}, std::span(&joint, 1), {}, {}, mounts);
    EXPECT_EQ(world.things(), 3u + 3u);
    WorldSnapshot snapshot;
    snapshot.objects.resize(world.placed_objects());
    ShownCommand shown;
    world.sample({3 * kSecond_ns}, snapshot, shown);
    ASSERT_EQ(snapshot.lamps.size(), 3u);
    const auto expect_at = [&](std::size_t i, Vec3d position_m, Vec3d axis, double level) {
        EXPECT_NEAR(length(snapshot.lamps[i].position_world_m - position_m), 0, 1e-9) << i;
        EXPECT_NEAR(length(snapshot.lamps[i].axis - axis), 0, 1e-12) << i;
        EXPECT_EQ(snapshot.lamps[i].level, level) << i;
    };
    expect_at(0, {1.1, 2, 3}, {0, 0, 1}, 1);
    expect_at(1, {10, 1, 6}, {0, 1, 0}, 0.5);
    // On the part: turned by a right angle about +y through (0, 1, 0), (0, 1, 1) is at (1, 1, 0) of the
    // object, whose x is the world's y.
    expect_at(2, {10 - 1, 1, 6}, {0, 1, 0}, 0);
}

TEST(WorldLamps, AreNumberedBehindTheOtherThings) {
    const Motion motions[2] = {standing({}), standing({})};
    const LampMount mounts[2] = {};
    WorldState world(motions, {}, {}, {}, {}, mounts);
    EXPECT_EQ(world.thing_of_lamp(2), 3u);
    EXPECT_FALSE(world.thing_of_lamp(0));
    EXPECT_FALSE(world.thing_of_lamp(3));
    EXPECT_TRUE(world.set_lamp(2, {{50}, 0.25}, {7, 100, {}, 9}));
    EXPECT_FALSE(world.set_lamp(3, {}, {}));
    WorldSnapshot snapshot;
    snapshot.objects.resize(1);
    ShownCommand shown;
    world.sample({60}, snapshot, shown);
    EXPECT_EQ(snapshot.lamps[0].level, 1);
    EXPECT_EQ(snapshot.lamps[1].level, 0.25);
    EXPECT_EQ(shown.sequence, 7u);
    EXPECT_EQ(shown.time.ns, 50);
    std::array<std::uint64_t, 4> numbers{};
    world.shown_numbers(numbers);
    EXPECT_EQ(numbers, (std::array<std::uint64_t, 4>{0, 0, 0, 9}));
    world.sample_again({40}, true, snapshot);
    EXPECT_EQ(snapshot.lamps[1].level, 1);
    world.average_lamps({40}, {60}, snapshot);
    EXPECT_DOUBLE_EQ(snapshot.lamps[1].level, 0.5 * 1 + 0.5 * 0.25);
}

// --- in a scenario

class LampsTest : public PlateTest {
  protected:
    // The plate in the dark, 4 m before the camera and its lamp.
    std::filesystem::path dark(const std::string& rest = "", const std::string& lamp = "lit: false") {
        return scenario(
            "", "sun: {spectrum: 0}\nlamps: [{name: flash, intensity_w_sr_um: 5000, " + lamp + "}]\n" + rest);
    }
    std::string refusal(const std::string& lamp) {
        const auto file = scenario("", "lamps: [{name: flash, " + lamp + "}]\n");
        return error_of([&] {
            const ScenarioConfig s = load_scenario(file, {});
            scene_lamps(s, SpectralGrid(s.spectrum_edges_um));
        });
    }
    SceneLamp lamp_of(const std::string& lamp, const std::string& edges_um) {
        const auto file = scenario("", "lamps: [{name: flash, " + lamp + "}]\n");
        const std::vector<std::string> overrides = {"spectrum_edges_um=" + edges_um};
        const ScenarioConfig s = load_scenario(file, overrides);
        return scene_lamps(s, SpectralGrid(s.spectrum_edges_um)).at(0);
    }
};

TEST_F(LampsTest, MistakesAreNamed) {
    EXPECT_THAT(refusal("lit: true"),
                HasSubstr("either 'intensity_w_sr_um' or 'intensity_w_sr'; found neither"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, intensity_w_sr: 1"), HasSubstr("found both"));
    EXPECT_THAT(refusal("intensity_w_sr: 1"), HasSubstr("'spectrum' go together"));
    EXPECT_THAT(refusal("intensity_w_sr: 1, spectrum: 2"), HasSubstr("'spectrum' is a number"));
    EXPECT_THAT(refusal("intensity_w_sr: 1, spectrum: [[0.5, 0], [0.6, 0]]"),
                HasSubstr("lamp 'flash': 'spectrum' is dark everywhere"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, on: plat"),
                HasSubstr("lamp 'flash': on: found 'plat'; accepted: camera, plate"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, on: plate, joint: 1"), HasSubstr("'plate' has 0"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, joint: 1"), HasSubstr("the camera has none"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, axis: [0, 0, 0]"), HasSubstr("'axis' has no direction"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, beam_angle_deg: 30, beam: [[0, 1]]"), HasSubstr("found both"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, beam: [[5, 1], [9, 0]]"),
                HasSubstr("'beam' begins off the axis"));
    EXPECT_THAT(refusal("intensity_w_sr_um: 1, level: 1.5"), HasSubstr("level"));
    std::string many = "intensity_w_sr_um: 1}";
    for (std::size_t i = 0; i < kMaxLamps; ++i) many += ", {name: more, intensity_w_sr_um: 1}";
    many.pop_back();
    EXPECT_THAT(refusal(many), HasSubstr("lamps: found 17; accepted: at most 16"));
    EXPECT_EQ(refusal("intensity_w_sr_um: [[0.4, 1], [0.5, 2]], beam: [[0, 1], [30, 0]]"), "no error");
}

// An LED of 3 W/sr, a triangle between 0.5 and 0.7 um: by the area of the triangle over each bin.
TEST_F(LampsTest, AWholeIntensityIsSpreadAsTheSpectrumSays) {
    const SceneLamp lamp =
        lamp_of("intensity_w_sr: 3, spectrum: [[0.5, 0], [0.6, 8], [0.7, 0]]", "[0.4, 0.55, 0.6, 0.9]");
    const double area[] = {0.5 * 0.25, 0.5 * 0.75, 0.5};  // of the whole
    const double width_um[] = {0.15, 0.05, 0.3};
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(lamp.intensity_w_sr_um[b], 3 * area[b] / width_um[b], 1e-4) << b;
    // Beyond the data sheet's ends it is dark; one number holds everywhere.
    EXPECT_NEAR(lamp_of("intensity_w_sr_um: [[0.5, 2], [0.6, 2]]", "[0.4, 0.8]").intensity_w_sr_um[0], 0.5,
                1e-6);
    EXPECT_EQ(lamp_of("intensity_w_sr_um: 7", "[0.4, 0.8]").intensity_w_sr_um[0], 7);
}

// --- frames

int brightest(const Collector::Frame& frame) { return *std::max_element(frame.dn.begin(), frame.dn.end()); }

TEST_F(LampsTest, ACommandSwitchesAtItsTime) {
    LoopRig rig(dark(), {}, {"mode=lockstep"});
    rig.loop.start();
    const auto at = [&](double s) { return rig.start + std::llround(s * 1e9); };
    EXPECT_EQ(rig.send(LampCommand{2, at(1), 1}), CommandStatus::kUnknownObject);
    EXPECT_EQ(rig.send(LampCommand{0, at(1), 1}), CommandStatus::kUnknownObject);
    // Exposures of 20 ms about whole seconds.
    EXPECT_EQ(rig.send(LampCommand{1, at(1.99), 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(LampCommand{1, at(4), 0}), CommandStatus::kAccepted);
    for (const double s : {1.0, 2.0, 3.0, 4.0, 5.0})
        EXPECT_EQ(rig.send(ExposeCommand{at(s), 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(5));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    constexpr int kOffset_dn = 50, kNoise_dn = 8;  // eight deviations of 5 e-
    const int full = brightest(frames[1]) - kOffset_dn;
    EXPECT_GT(full, 20 * kNoise_dn);
    EXPECT_LT(brightest(frames[0]), kOffset_dn + kNoise_dn);
    EXPECT_NEAR(brightest(frames[2]) - kOffset_dn, full, 0.1 * full);        // the brightest of noisy pixels
    EXPECT_NEAR(brightest(frames[3]) - kOffset_dn, 0.5 * full, 0.1 * full);  // off at its middle
    EXPECT_LT(brightest(frames[4]), kOffset_dn + kNoise_dn);
}

// Five frames, a second apart.
void expose_each_second(EventRig& bench) {
    LoopRig& rig = bench.rig;
    for (int s = 1; s <= 5; ++s)
        EXPECT_EQ(rig.send(ExposeCommand{rig.start + s * kSecond_ns, 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(5));
    bench.stop();
}

TEST_F(LampsTest, AnEventSwitchesAtItsTime) {
    EventRig bench(
        dark("events:\n"
             "  - {at_s: 2.5, do: lamp on --level 0.5}\n"
             "  - {at_frame: 4, do: lamp off}\n"));
    ASSERT_NO_FATAL_FAILURE(expose_each_second(bench));
    const LoopRig& rig = bench.rig;
    const bool lit[] = {false, false, true, false, false};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(brightest(rig.collector.frames[i]) > 100, lit[i]) << i;
}

// Exposures of 20 ms about each second: a quarter of the second one comes after the event, which comes after its middle; a flash
// of 5 ms lights the fourth for a quarter of its time.
TEST_F(LampsTest, AnEventInLockstepSwitchesWhileTheShutterIsOpen) {
    EventRig bench(
        dark("events:\n"
             "  - {at_s: 2.005, do: lamp on}\n"
             "  - {at_s: 3.5, do: lamp off}\n"
             "  - {name: flash, at_s: 4.002, do: lamp on}\n"
             "  - {after: flash, delay_s: 0.005, do: lamp off}\n"));
    ASSERT_NO_FATAL_FAILURE(expose_each_second(bench));
    const LoopRig& rig = bench.rig;
    constexpr int kOffset_dn = 50, kNoise_dn = 8;  // eight deviations of 5 e-
    const auto light = [&](std::size_t i) { return 1.0 * brightest(rig.collector.frames[i]) - kOffset_dn; };
    const double full = light(2);
    EXPECT_GT(full, 20 * kNoise_dn);
    EXPECT_LT(light(0), kNoise_dn);
    EXPECT_NEAR(light(1), 0.25 * full, 0.1 * full);  // the brightest of noisy pixels
    EXPECT_NEAR(light(3), 0.25 * full, 0.1 * full);
    EXPECT_LT(light(4), kNoise_dn);
}

// The radiance of the whole picture at the start, the lamp lit for the last quarter of 20 ms.
TEST_F(LampsTest, ASwitchDuringTheExposureCountsForItsShareOfTheTime) {
    const auto light = [&](const std::string& motion, bool switched) {
        const auto file =
            dark("camera_pose: {rate_deg_s: [0, -30, 0]}\n", switched ? "lit: false" : "lit: true");
        const std::vector<std::string> overrides = {"quality.motion=" + motion, "quality.samples_per_axis=8"};
        const ScenarioConfig s = load_scenario(file, overrides);
        const SpectralGrid grid(s.spectrum_edges_um);
        const auto renderer =
            load_renderer(s, grid, geometry_of(s.camera, static_cast<int>(s.quality.guard_px)));
        const TimeTai start = parse_utc(s.time_utc);
        WorldState world(initial_motions(s, start), s.origin, {}, {}, {}, lamp_mounts(s));
        if (switched) {
            EXPECT_TRUE(world.set_lamp(1, {start + 5'000'000, 1}, {1, 1}));
        }
        ExposureRenderer exposures(*renderer, exposure_config_of(s), s.camera, grid, world.placed_objects());
        RadianceImage radiance = exposures.make_image();
        std::vector<PointSource> points;
        points.reserve(exposures.max_points());
        Exposure exposure;
        exposure.exposure_s = 0.02;
        const auto result = exposures.render(world, start, {1, 1}, radiance, points, exposure);
        EXPECT_EQ(result.parts > 1, motion == "exact");
        double sum = 0;
        for (const float value : radiance.plane(0)) sum += static_cast<double>(value);
        return sum;
    };
    for (const std::string& motion : {std::string("off"), std::string("fast")})
        EXPECT_NEAR(light(motion, true) / light(motion, false), 0.25, 1e-6) << motion;
    // Of parts each has its own share: the quarter is seen where the plate is then. Its light is the same all
    // along the way to 1e-3, by the rays that find its edges.
    EXPECT_NEAR(light("exact", true) / light("exact", false), 0.25, 2e-3);
}

TEST_F(LampsTest, AClockThatGoesBackBeginsTheirSwitchesAnew) {
    LoopRig rig(dark(), {}, {"mode=lockstep"});
    const auto switch_at = [&](int s, double level) {
        return rig.send(LampCommand{1, rig.start + s * kSecond_ns, level});
    };
    const auto level_at = [&](int s) {
        WorldSnapshot snapshot;
        snapshot.objects.resize(rig.world.placed_objects());
        ShownCommand shown;
        rig.world.sample(rig.start + s * kSecond_ns, snapshot, shown);
        return snapshot.lamps[0].level;
    };
    EXPECT_EQ(switch_at(50, 1), CommandStatus::kAccepted);
    EXPECT_EQ(switch_at(60, 0.25), CommandStatus::kAccepted);
    EXPECT_EQ(level_at(55), 1);
    EXPECT_EQ(switch_at(10, 0.5), CommandStatus::kAccepted);  // 50 s back: more than late
    EXPECT_EQ(rig.poses.went_back(), 1u);
    EXPECT_EQ(level_at(70), 0.5);  // the future that was given up does not come
    EXPECT_EQ(level_at(5), 0.25);
}

TEST(PoseWatch, ALampIsNoPose) {
    PoseWatch watch({.stale_after_s = 1});
    watch.took({0, 0, 1}, {}, {}, PoseWatch::Verdict::kForwards);
    EXPECT_FALSE(watch.at({10 * kSecond_ns}).stale);  // no pose has come yet
    watch.took({0, 0, 0}, {}, {}, PoseWatch::Verdict::kForwards);
    watch.took({0, 0, 1}, {5 * kSecond_ns}, {5 * kSecond_ns}, PoseWatch::Verdict::kForwards);
    EXPECT_TRUE(watch.at({5 * kSecond_ns}).stale);
}

}  // namespace
}  // namespace hilcam
