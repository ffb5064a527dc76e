#include "emulator/bench/sensor_bench.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "emulator/progress/progress.h"
#include "render/vocabulary/median.h"
#include "render/vocabulary/stopwatch.h"
#include "render/vocabulary/units.h"
#include "sensor/chain.h"

namespace hilcam {
namespace {

struct Effect {
    const char* name;
    std::function<void(CameraModel&, Exposure&)> turn_on;
};

// Turns on the effects that every data sheet has.
void turn_on_common(CameraModel& c) {
    c.prnu_fraction = 0.01, c.dsnu_e = 5, c.dark_current_e_s = 125;
    c.fixed_pattern.dark_current_fraction = 0.3, c.fixed_pattern.column_e = 2, c.fixed_pattern.row_e = 1;
    c.defects.hot_fraction = 1e-4, c.defects.hot_e_s = 5000, c.defects.dead_fraction = 1e-5;
    c.read_noise_e = 13, c.reset_noise_e = 2, c.row_noise_e = 1;
    c.nonlinearity = {-0.01};
    c.diffusion_m = 1e-6, c.crosstalk_fraction = 0.01, c.wavefront_rms_m = 30e-9;
    c.stray_light.veiling_glare_fraction = 0.005;
    c.jitter.rms_rad = {1e-6, 1e-6};
}

const std::vector<Effect>& effects() {
    static const std::vector<Effect> list = {
        {"smear of 5 px",
         [](CameraModel&, Exposure& e) {
             e.image_rate_px_s = {4 / e.exposure_s, 3 / e.exposure_s};
         }},
        {"trails of 20 px",
         [](CameraModel& c, Exposure& e) {
             e.camera_rate_rad_s = {0, 20 * c.pitch_m / (c.focal_length_m * e.exposure_s), 0};
         }},
        {"zernike",
         [](CameraModel& c, Exposure&) {
             c.zernike_m = {0, 20e-9, 20e-9, 20e-9, 20e-9};
         }},
        {"three field zones",
         [](CameraModel& c, Exposure&) {
             c.field_zones = {{0, 0, 0}, {0.5, 5e-6, 30e-9}, {1, 2e-5, 60e-9}};
         }},
        {"ghost", [](CameraModel& c, Exposure&) { c.stray_light.ghost_fraction = 1e-3; }},
        {"bayer filters",
         [](CameraModel& c, Exposure&) {
             c.color_filter = {
                 "RG GB",
                 {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.7)}, {"B", Curve::constant(0.6)}}};
         }},
        {"frame transfer smear",
         [](CameraModel& c, Exposure&) { c.shutter.kind = ShutterKind::kFrameTransfer; }},
        {"blooming", [](CameraModel& c, Exposure&) { c.ccd.blooming = true; }},
        {"transfer inefficiency",
         [](CameraModel& c, Exposure&) { c.ccd.parallel_inefficiency = c.ccd.serial_inefficiency = 1e-5; }},
        {"cosmic rays", [](CameraModel& c, Exposure&) { c.cosmic_rays.rate_cm2_s = 1e4; }},
        {"1/f noise", [](CameraModel& c, Exposure&) { c.flicker_noise_e = 2; }},
        {"telegraph pixels",
         [](CameraModel& c, Exposure&) { c.defects.telegraph_fraction = 1e-3, c.defects.telegraph_e = 20; }},
        {"filters along rows",
         [](CameraModel& c, Exposure&) {
             c.filters = {0.4, 0.001, 0.3};
         }},
        {"converter errors",
         [](CameraModel& c, Exposure&) { c.converter.inl_lsb = 2, c.converter.dnl_lsb = 0.2; }},
        {"companding", [](CameraModel& c, Exposure&) { c.converter.companding = Companding::kSquareRoot; }},
        {"binning of charge", [](CameraModel& c, Exposure&) { c.binning_x = c.binning_y = 2; }},
    };
    return list;
}

// A picture with a disk as bright as a sunlit white surface over a third of its area, on black, and a star in
// every 10,000 pixels.
struct TimedPicture {
    RadianceImage radiance;
    std::vector<PointSource> points;

    TimedPicture(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling) {
        const ImageGeometry g = geometry_of(camera, sampling.guard_px, sampling.oversampling);
        radiance = RadianceImage(g.padded_width(), g.padded_height(), grid.size());
        const double radius_px = std::sqrt(g.padded_width() * g.padded_height() / (3 * kPi));
        constexpr int kBlock_px = RadianceImage::kBlock_px;
        for (int y = 0; y < radiance.height(); ++y)
            for (int x = 0; x < radiance.width(); ++x) {
                const bool lit =
                    std::hypot(x - 0.5 * radiance.width(), y - 0.5 * radiance.height()) < radius_px;
                if (x % kBlock_px == 0 && y % kBlock_px == 0) radiance.mark_dark(x, y, true);
                if (!lit) continue;
                radiance.mark_dark(x, y, false);
                for (int b = 0; b < grid.size(); ++b)
                    radiance.row(y, b)[static_cast<std::size_t>(x)] = static_cast<float>(300 + x % 200);
            }
        const int stars = g.width_px * g.height_px / 10000;
        for (int i = 0; i < stars; ++i) {
            const auto words =
                random_words({1, 0}, RandomPurpose::kPathSample, static_cast<std::uint32_t>(i));
            PointSource star;
            star.position_px = {uniform01(words[0]) * static_cast<float>(g.width_px),
                                uniform01(words[1]) * static_cast<float>(g.height_px)};
            for (int b = 0; b < grid.size(); ++b) star.irradiance_w_m2_um[b] = 1e-8f * uniform01(words[2]);
            points.push_back(star);
        }
    }
};

// A camera that processes a picture.
class Rig {
  public:
    Rig(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
        const TimedPicture& picture, const Exposure& exposure)
        : picture_(picture),
          exposure_(exposure),
          chain_(camera, grid, sampling),
          mean_e_(array_size(camera)[0], array_size(camera)[1]),
          frame_(frame_size(camera)[0], frame_size(camera)[1]) {}

    // Returns the time of one frame [ms].
    double run() {
        const Stopwatch watch;
        chain_.expose(picture_.radiance, picture_.points, exposure_, mean_e_);
        chain_.digitise(mean_e_, exposure_, {1, ++frames_}, frame_);
        return watch.ms();
    }
    SensorChain& chain() { return chain_; }

  private:
    const TimedPicture& picture_;
    Exposure exposure_;
    SensorChain chain_;
    ElectronImage mean_e_;
    DnImage frame_;
    std::uint64_t frames_ = 0;
};

// Times the stage and the bare FFT pair in turns, so that both see the same load of the machine.
SensorStageTimes time_stage(Rig& rig, int runs) {
    std::vector<double> all, collapse, convolve, points, digitise, pair;
    for (int i = 0; i < runs; ++i) {
        all.push_back(rig.run());
        const SensorTimes& t = rig.chain().times();
        collapse.push_back(t.collapse_ms), convolve.push_back(t.convolve_ms);
        points.push_back(t.points_ms), digitise.push_back(t.digitise_ms);
        pair.push_back(rig.chain().fft_pair_ms());
    }
    return {median(all), median(collapse), median(convolve), median(points), median(digitise), median(pair)};
}

// Measures how much longer a second rig takes, alternating frame by frame.
double extra_ms(Rig& base, Rig& with, int runs) {
    std::vector<double> differences;
    with.run();
    for (int i = 0; i < runs; ++i) {
        const double without_ms = base.run();
        differences.push_back(with.run() - without_ms);
    }
    return median(differences);
}

double copy_ms(const CameraModel& camera, int runs) {
    const auto [width, height] = frame_size(camera);
    const DnImage from(width, height);
    DnImage to(width, height);
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) {
        const Stopwatch watch;
        std::copy(from.all().begin(), from.all().end(), to.all().begin());
        times.push_back(watch.ms());
    }
    return median(times);
}

}  // namespace

SensorBench bench_sensor(const ScenarioConfig& scenario, int runs) {
    const SpectralGrid grid(scenario.spectrum_edges_um);
    const SensorSampling sampling = sampling_of(scenario.quality);
    CameraModel common = scenario.camera;
    turn_on_common(common);
    const TimedPicture picture(common, grid, sampling);
    const Exposure plain{.exposure_s = common.exposure_s};
    Rig base_rig(common, grid, sampling, picture, plain);
    for (int i = 0; i < 5; ++i) base_rig.run();  // warming up
    SensorBench out;
    out.camera = common.name;
    out.width_px = frame_size(common)[0], out.height_px = frame_size(common)[1];
    out.runs = runs;
    out.base = time_stage(base_rig, runs);
    out.floor_ms = out.base.fft_pair_ms + copy_ms(common, runs);
    Progress progress("sensor stage", static_cast<double>(effects().size()));
    for (const Effect& effect : effects()) {
        CameraModel camera = common;
        Exposure exposure = plain;
        effect.turn_on(camera, exposure);
        Rig rig(camera, grid, sampling, picture, exposure);
        out.effects.push_back({effect.name, extra_ms(base_rig, rig, runs)});
        progress.done(static_cast<double>(out.effects.size()));
    }
    return out;
}

}  // namespace hilcam
