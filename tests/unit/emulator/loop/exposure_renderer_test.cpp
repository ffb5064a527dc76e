#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/run/emulator.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

// One exposure of a scenario at its start.
struct Shot {
    RadianceImage radiance;
    std::vector<PointSource> points;
    Exposure exposure;
    ExposureRenderer::Result result;
};
Shot shoot(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const ScenarioConfig s = load_scenario(file, overrides);
    const SpectralGrid grid(s.spectrum_edges_um);
    const auto renderer = load_renderer(s, grid,
                                        geometry_of(s.camera, static_cast<int>(s.quality.guard_px),
                                                    static_cast<int>(s.quality.oversampling)));
    const TimeTai start = parse_utc(s.time_utc);
    WorldState world(initial_motions(s, start), s.origin, joints_of(s), {}, {}, lamp_mounts(s));
    ExposureRenderer exposures(*renderer, exposure_config_of(s), s.camera, grid, world.placed_objects());
    Shot shot;
    shot.radiance = exposures.make_image();
    shot.points.reserve(exposures.max_points());
    shot.exposure.exposure_s = s.camera.exposure_s;
    shot.result = exposures.render(world, start, {1, 1}, shot.radiance, shot.points, shot.exposure);
    return shot;
}

// Light, middle and variance along x [px] of an image.
struct Moments {
    double light = 0, x = 0, variance = 0;
};
Moments moments_of(const RadianceImage& image) {
    Moments m;
    for (int pass = 0; pass < 2; ++pass) {
        double sum = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const double value = image.row(y)[static_cast<std::size_t>(x)];
                if (pass == 0)
                    m.light += value, sum += value * (x + 0.5);
                else
                    sum += value * (x + 0.5 - m.x) * (x + 0.5 - m.x);
            }
        (pass == 0 ? m.x : m.variance) = sum / m.light;
    }
    return m;
}
double difference(const RadianceImage& a, const RadianceImage& b) {
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        sum += std::abs(static_cast<double>(a.data()[i]) - static_cast<double>(b.data()[i]));
        all += static_cast<double>(b.data()[i]);
    }
    return sum / all;
}

// quality of all the shots below
const std::string kQuality = "quality.samples_per_axis=16";

class ExposureRendererTest : public PlateTest {};

TEST_F(ExposureRendererTest, FastAndExactHaveTheSameBlurForASmallTurn) {
    // 640 px/rad x 0.6 rad/s x 20 ms = 7.68 px to the right.
    const auto file = scenario("", "camera_pose: {rate_deg_s: [0, -34.377, 0]}\n");
    const Shot off = shoot(file, {kQuality, "quality.motion=off"});
    const Shot fast = shoot(file, {kQuality, "quality.motion=fast"});
    const Shot exact = shoot(file, {kQuality, "quality.motion=exact", "quality.motion_error_px=0.3"});
    EXPECT_EQ(fast.result.parts, 1);
    EXPECT_EQ(exact.result.parts, 26);
    const double t = 0.02, way_px = fast.exposure.image_rate_px_s.x * t;
    // f omega T; 0.7 degrees off the middle a few 1e-5 more.
    EXPECT_NEAR(way_px, 7.68, 0.002);
    EXPECT_NEAR(fast.exposure.image_rate_px_s.y, 0, 1e-6);
    EXPECT_NEAR(fast.exposure.camera_rate_rad_s.y, -0.6, 1e-5);
    EXPECT_EQ(std::memcmp(fast.radiance.data(), off.radiance.data(), off.radiance.pixels() * sizeof(float)),
              0);
    const Moments still = moments_of(off.radiance), parts = moments_of(exact.radiance);
    // Blurring along d adds d^2 / 12; exact adds what lies between its parts by its own image rate.
    const double step_px = exact.exposure.image_rate_px_s.x * t;
    EXPECT_NEAR(step_px, way_px / exact.result.parts, 1e-3);
    EXPECT_NEAR(parts.light / still.light, 1, 1e-3);
    EXPECT_NEAR(parts.x, still.x, 0.02);
    // The plate lies on whole pixels; at an average place the pixel's own variance of 1/12 is in the picture
    // twice more than it is there (box of 16 px: 16^2 / 12 - 1/12 when aligned, + 1/12 on average).
    const double fast_variance = still.variance + 2.0 / 12 + way_px * way_px / 12;
    const double exact_variance = parts.variance + step_px * step_px / 12;
    // 16 rays to a pixel find each of the two edges within 1/32 px, in each part anew: 8 px x 2 x 1/32 px
    // / sqrt(26) x 2 / 16 px of some 26 px^2.
    EXPECT_NEAR(exact_variance, fast_variance, 0.012);
    EXPECT_GT(fast_variance / still.variance, 1.15);  // what is compared is no trifle
}

// The same through the sensor: mean electrons of the frame.
ElectronImage electrons_of(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const ScenarioConfig s = load_scenario(file, overrides);
    const Shot shot = shoot(file, overrides);
    SensorChain chain(s.camera, SpectralGrid(s.spectrum_edges_um), sampling_of(s.quality));
    ElectronImage electrons(64, 64);
    chain.expose(shot.radiance, shot.points, shot.exposure, electrons);
    return electrons;
}
// Root mean square of the difference over the peak.
double rms(const ElectronImage& a, const ElectronImage& b) {
    double sum = 0, peak = 0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        const double d = static_cast<double>(a.data()[i]) - static_cast<double>(b.data()[i]);
        sum += d * d;
        peak = std::max(peak, static_cast<double>(b.data()[i]));
    }
    return std::sqrt(sum / static_cast<double>(a.pixels())) / peak;
}

TEST_F(ExposureRendererTest, FastAndExactGiveTheSameElectronsForASmallTurn) {
    // Down and to the right, 7.7 and 3.2 px.
    const auto file = scenario("", "camera_pose: {rate_deg_s: [14.3, -34.377, 0]}\n");
    const auto frame = [&](const std::string& motion, const std::string& error_px, const std::string& finer) {
        return electrons_of(file, {"quality.samples_per_axis=8", "quality.motion=" + motion,
                                   "quality.motion_error_px=" + error_px, "quality.oversampling=" + finer});
    };
    // The share of motion's effect that is left: of radiance pixels as wide as the detector's the plate's
    // edges alias, in one place with fast, in many with exact; of finer ones the blur itself is compared.
    const auto left_over = [&](const std::string& finer, const std::string& motion,
                               const std::string& error_px) {
        const ElectronImage exact = frame("exact", "0.3", finer), off = frame("off", "1", finer);
        EXPECT_GT(rms(off, exact), 0.05);
        return rms(frame(motion, error_px, finer), exact) / rms(off, exact);
    };
    EXPECT_LT(left_over("1", "fast", "1"), 0.06);
    EXPECT_LT(left_over("4", "fast", "1"), 0.01);
    EXPECT_LT(left_over("4", "exact", "2"), 0.01);  // the image rate covers the step
}

TEST_F(ExposureRendererTest, FastMissesATurnAboutTheBoresightAndExactDoesNot) {
    const auto file = scenario("", "camera_pose: {rate_deg_s: [0, 0, 1146], position_m: [0.06, 0.03, 0]}\n");
    const auto frame = [&](const std::string& motion, const std::string& error_px) {
        return electrons_of(file, {"quality.samples_per_axis=8", "quality.motion=" + motion,
                                   "quality.motion_error_px=" + error_px, "quality.oversampling=2"});
    };
    const ElectronImage reference = frame("exact", "0.5");
    const double all = rms(frame("off", "1"), reference);
    EXPECT_GT(rms(frame("fast", "1"), reference), 0.3 * all);
    EXPECT_LT(rms(frame("exact", "2"), reference), 0.1 * all);
}

TEST_F(ExposureRendererTest, ExactConvergesWhereFastCannotFollow) {
    // About the boresight: 23 degrees in an exposure; the plate lies off the middle.
    const auto file = scenario("", "camera_pose: {rate_deg_s: [0, 0, 1146], position_m: [0.06, 0.03, 0]}\n");
    const auto at = [&](const std::string& error_px) {
        return shoot(file, {kQuality, "quality.motion=exact", "quality.motion_error_px=" + error_px});
    };
    const Shot reference = at("0.5"), coarse = at("2"), coarser = at("8");
    ASSERT_FALSE(reference.result.parts_limited);
    EXPECT_NEAR(reference.result.parts, 4 * coarse.result.parts, 4);
    const Shot off = shoot(file, {kQuality, "quality.motion=off"});
    const double without = difference(off.radiance, reference.radiance);
    EXPECT_GT(without, 0.1);
    // Parts are steps in an edge's ramp; against a ramp of 4 times as many they leave a share that falls with
    // the step: 9 parts a ninth of what one leaves.
    EXPECT_LT(difference(coarse.radiance, reference.radiance), without / 9);
    EXPECT_LT(difference(coarse.radiance, reference.radiance),
              difference(coarser.radiance, reference.radiance) / 2);
}

TEST_F(ExposureRendererTest, AStillSceneIsTheSameToTheBitInEveryMode) {
    const auto file = scenario();
    const Shot off = shoot(file, {"quality.motion=off"});
    for (const char* mode : {"quality.motion=fast", "quality.motion=exact"}) {
        const Shot shot = shoot(file, {mode});
        EXPECT_EQ(shot.result.parts, 1);
        EXPECT_EQ(shot.exposure.image_rate_px_s.x, 0);
        EXPECT_EQ(shot.exposure.camera_rate_rad_s.y, 0);
        EXPECT_EQ(
            std::memcmp(shot.radiance.data(), off.radiance.data(), off.radiance.pixels() * sizeof(float)), 0)
            << mode;
    }
}

TEST_F(ExposureRendererTest, TooMuchMotionIsLimitedAndTold) {
    const auto file = scenario("", "camera_pose: {rate_deg_s: [0, -34.377, 0]}\n");
    const Shot exact = shoot(file, {"quality.motion=exact", "quality.motion_error_px=0.01"});
    EXPECT_EQ(exact.result.parts, ExposureRenderer::kMaxParts);
    EXPECT_TRUE(exact.result.parts_limited);
}

TEST_F(ExposureRendererTest, ALineScannerIsBlurredByWhatItsLinesDoNotExpect) {
    // 640 px/rad, lines of 1 ms: 1 px per line is 1.5625 rad/s; the boresight goes down at 1.1 times that.
    const auto file = scenario("", "camera_pose: {rate_deg_s: [-98.475, 0, 0]}\n");
    const auto rate = [&](const std::string& shutter) {
        const Exposure exposure =
            shoot(file, {"camera.shutter={kind: line_scan, line_time_us: 1000" + shutter + "}",
                         "camera.exposure_ms=1"})
                .exposure;
        EXPECT_NEAR(exposure.camera_rate_rad_s.x * 640, exposure.image_rate_px_s.y, 0.5);
        return exposure.image_rate_px_s.y;
    };
    // The picture goes up at 1100 px/s; the charge of several stages at 1000, and so does one stage's line.
    EXPECT_NEAR(rate(", tdi_stages: 4"), -100, 1);
    EXPECT_NEAR(rate(""), -100, 1);
    // At rest, charge that moves smears the picture; one line alone does not.
    const auto still = scenario();
    const auto at_rest = [&](const std::string& shutter) {
        return shoot(still, {"camera.shutter={kind: line_scan, line_time_us: 1000" + shutter + "}"})
            .exposure.image_rate_px_s.y;
    };
    EXPECT_NEAR(std::abs(at_rest(", tdi_stages: 4")), 1000, 1e-6);
    EXPECT_EQ(at_rest(""), 0);
}

TEST_F(ExposureRendererTest, JitterTurnsTheCameraAsItsPsdSays) {
    // 0.3 deg rms below 1 Hz, an exposure of 20 ms: all of it is displacement.
    const auto file = scenario(", jitter: {psd: [[0.1, 1300000], [1, 1300000]]}");
    const ScenarioConfig s = load_scenario(file, {});
    const PointingJitter jitter(s.camera.jitter, static_cast<std::uint64_t>(s.seed), parse_utc(s.time_utc));
    const Vec2d angle = jitter.at(parse_utc(s.time_utc), s.camera.exposure_s);
    ASSERT_GT(std::abs(angle.y), 0.001);
    const Moments shaken = moments_of(shoot(file, {kQuality, "quality.motion=off"}).radiance),
                  calm = moments_of(shoot(scenario(), {kQuality, "quality.motion=off"}).radiance);
    EXPECT_NEAR(shaken.x - calm.x, -640 * angle.y, 0.05);
}

TEST_F(ExposureRendererTest, TheShutterOfTheCameraChoosesTheRays) {
    const auto rolling = scenario(", shutter: {kind: rolling, line_time_us: 30}");
    const auto rays = [&](const std::vector<std::string>& overrides) {
        return models_of(load_scenario(rolling, overrides)).rays;
    };
    EXPECT_EQ(rays({}).model, "rolling");
    EXPECT_DOUBLE_EQ(rays({"quality.oversampling=2"}).line_time_s, 15e-6);
    EXPECT_EQ(rays({"camera.shutter.kind=line_scan"}).model, "pushbroom");
    EXPECT_EQ(rays({"camera.shutter.kind=frame_transfer"}).model, "pinhole");
    const auto message = [&](const std::vector<std::string>& overrides) {
        return error_of([&] { load_scenario(rolling, overrides); });
    };
    EXPECT_NE(message({"rays={model: pinhole}"}).find("the camera's shutter asks for 'rolling'"),
              std::string::npos)
        << message({"rays={model: pinhole}"});
    EXPECT_NE(message({"rays={model: rolling, line_time_us: 20}"}).find("camera.shutter.line_time_us is 30"),
              std::string::npos);
    EXPECT_EQ(message({"rays={model: rolling, line_time_us: 30}"}), "no error");
}

TEST(ShutterTiming, FollowsItsTable) {
    CameraModel c;
    c.height_px = 1000;
    c.shutter.line_time_s = 20e-6;
    const ShutterTiming global(c);
    EXPECT_DOUBLE_EQ(global.middle_s(5e-3), 2.5e-3);
    EXPECT_DOUBLE_EQ(global.period_s(100, 5e-3), 0.01);
    c.shutter.kind = ShutterKind::kRolling;
    const ShutterTiming rolling(c);
    EXPECT_DOUBLE_EQ(rolling.middle_s(5e-3), 12.49e-3);
    EXPECT_DOUBLE_EQ(rolling.end_s(5e-3), 24.98e-3);
    EXPECT_DOUBLE_EQ(rolling.period_s(100, 5e-3), 0.02);
    EXPECT_DOUBLE_EQ(rolling.period_s(100, 0.5), 0.5);
    c.shutter.kind = ShutterKind::kLineScan;
    c.shutter.tdi_stages = 16;
    const ShutterTiming line(c);
    EXPECT_DOUBLE_EQ(line.exposure_s(1), 320e-6);
    EXPECT_DOUBLE_EQ(line.period_s(1, 1), 0.02);
    EXPECT_DOUBLE_EQ(line.middle_s(320e-6), 0.01);
    c.shutter.kind = ShutterKind::kGlobal;
    c.sequence = {{.exposure_s = 1e-3}, {.exposure_s = 0.05}};
    EXPECT_DOUBLE_EQ(ShutterTiming(c).period_s(100, 1e-3), 0.05);
}

TEST(LiveSettings, RefusesWhatTheCameraSetsItself) {
    CameraModel c;
    c.shutter.kind = ShutterKind::kLineScan;
    LiveSettings line(c);
    EXPECT_FALSE(line.change({.exposure_s = line.settings().exposure_s}));
    EXPECT_FALSE(line.change({.frame_rate_hz = 30}));
    EXPECT_TRUE(line.change({.gain_db = 3}));
    EXPECT_DOUBLE_EQ(line.settings().exposure_s, 20e-6);
    CameraModel a;
    a.auto_exposure.on = true;
    LiveSettings automatic(a);
    EXPECT_FALSE(automatic.change({.exposure_s = 1e-3}));
    automatic.report_own(0.25, 0);
    EXPECT_EQ(automatic.settings().exposure_s, 0.25);

    const Motion initial;
    WorldState world(std::span(&initial, 1), {});
    FaultBoard faults;
    SimulatedClock clock({0}, 0);
    CommandDispatch dispatch({{&world, &automatic, &faults}}, clock);
    SettingsCommand command;
    command.exposure_s = 1e-3;
    command.gain_db = 6;
    EXPECT_EQ(dispatch.handle(command, {1, 0}), CommandStatus::kBadArgument);
    EXPECT_EQ(automatic.settings().gain_db, 0);
}

std::vector<Collector::Frame> run_loop(const std::filesystem::path& file, std::uint64_t frames,
                                       const std::vector<std::string>& overrides = {}) {
    LoopRig rig(file, {frames, false}, overrides);
    rig.loop.start();
    while (!rig.loop.finished()) sleep_until_monotonic_ns(monotonic_ns() + 1'000'000);
    rig.loop.stop();
    return std::move(rig.collector.frames);
}

TEST_F(ExposureRendererTest, FramesOfARollingAndALineCameraFollowTheirTiming) {
    const auto rolling = run_loop(scenario(", shutter: {kind: rolling, line_time_us: 100}"), 3);
    ASSERT_EQ(rolling.size(), 3u);
    EXPECT_DOUBLE_EQ(rolling[0].record.exposure_s, 0.02);
    const auto line = run_loop(scenario(", shutter: {kind: line_scan, line_time_us: 100, tdi_stages: 3}"), 3);
    ASSERT_EQ(line.size(), 3u);
    EXPECT_DOUBLE_EQ(line[0].record.exposure_s, 300e-6);
}

TEST_F(ExposureRendererTest, TheLoopTakesTheStepsOfASequenceInTurn) {
    const auto frames = run_loop(
        scenario(", sequence: [{exposure_ms: 1}, {exposure_ms: 4, gain_db: 6}, {exposure_ms: 16}]"), 8);
    ASSERT_EQ(frames.size(), 8u);
    for (const auto& frame : frames) {
        const std::size_t step = (frame.record.id - 1) % 3;
        EXPECT_DOUBLE_EQ(frame.record.exposure_s, (std::array{1e-3, 4e-3, 16e-3}[step]));
        EXPECT_EQ(frame.record.gain_db, (std::array{0.0, 6.0, 0.0}[step]));
    }
    // And they are exposed so: the plate's middle above black.
    const auto middle = [&](std::size_t k) { return frames[k].dn[32 * 64 + 32] - 50.0; };
    // Shot noise of 500 e- and 5 e- of read noise: 5 % of the first, at three sigma.
    EXPECT_NEAR(middle(2) / middle(0), 16, 16 * 0.15);
    EXPECT_GT(middle(1), 5 * middle(0));
}

TEST_F(ExposureRendererTest, AutomaticExposureTakesEffectTwoFramesLater) {
    const auto frames = run_loop(scenario(", auto_exposure: {on: true, speed: 1, percentile: 98}"), 12,
                                 {"camera.exposure_ms=2"});
    ASSERT_EQ(frames.size(), 12u);
    AutoExposureConfig config;
    config.speed = 1;
    EXPECT_DOUBLE_EQ(frames[0].record.exposure_s, 0.002);
    EXPECT_DOUBLE_EQ(frames[1].record.exposure_s, 0.002);
    for (std::size_t k = 0; k + 2 < frames.size(); ++k) {
        std::vector<std::uint16_t> dn = frames[k].dn;
        std::sort(dn.begin(), dn.end());
        // Full well at 50 + 0.2 x 20,000 DN; the 98th percentile of 4096 pixels is the 4015th.
        const double fraction = (dn[4014] - 50) / 4000.0;
        EXPECT_DOUBLE_EQ(
            frames[k + 2].record.exposure_s,
            next_exposure_s(config, {fraction, fraction >= 0.98}, frames[k].record.exposure_s, {1e-6, 10}))
            << k;
    }
    // It ends where half of full scale is.
    std::vector<std::uint16_t> last = frames.back().dn;
    std::sort(last.begin(), last.end());
    EXPECT_NEAR(std::log2((last[4014] - 50) / 4000.0 / 0.5), 0, 0.1);
    EXPECT_GT(frames.back().record.exposure_s, 0.008);
}

}  // namespace
}  // namespace hilcam
