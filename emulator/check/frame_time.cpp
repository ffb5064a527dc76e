#include "emulator/check/frame_time.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <limits>

#include "emulator/loop/shutter_timing.h"
#include "emulator/run/trial_frames.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/quality_ladder.h"
#include "render/vocabulary/median.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

constexpr int kFrames = 3;

template <class Work>
double milliseconds(const Work& work) {
    const Stopwatch watch;
    work();
    return watch.ms();
}

}  // namespace

std::optional<StrayTime> stray_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures) {
    const ScenarioConfig& s = station.scenario();
    StrayTime out{};
    const auto add = [&](bool there, const char* name) {
        if (there) out.parts += (out.parts.empty() ? "" : ", ") + std::string(name);
    };
    const StrayLightConfig& stray = s.camera.stray_light;
    add(stray.veiling_glare_fraction > 0, stray.glare_radius_px > 0 ? "halo" : "veiling glare");
    add(stray.ghost_fraction > 0, "ghost");
    add(s.camera.spider.vanes > 0, "spikes");
    add(s.camera.outside_light.has_value(), "light from beside the picture");
    if (out.parts.empty() || primary_rays(s, render_quality_of(s)) > kMaxTrialRays) return {};

    CameraModel clean = s.camera;
    clean.stray_light = {}, clean.spider = {}, clean.outside_light.reset();
    const SpectralGrid grid(s.spectrum_edges_um);
    SensorChain without(clean, grid, sampling_of(s), load_detector_pictures(clean));
    RadianceImage radiance = exposures.make_image();
    std::vector<PointSource> points;
    points.reserve(exposures.max_points());
    std::vector<SideLight> beside;
    Exposure exposure{ShutterTiming(s.camera).exposure_s(s.camera.exposure_s), s.camera.gain_db, {}, {}};
    exposures.render(world, parse_utc(s.time_utc), {}, radiance, points, exposure);
    if (s.camera.outside_light) exposures.look_beside(beside);
    const auto [width, height] = array_size(s.camera);
    ElectronImage electrons(width, height);
    double with_ms = std::numeric_limits<double>::infinity(), without_ms = with_ms;
    // The first measurement of each is ignored.
    for (int i = 0; i <= kFrames; ++i) {
        const double with =
            milliseconds([&] { station.chain().expose(radiance, points, exposure, electrons, beside); });
        const double plain = milliseconds([&] { without.expose(radiance, points, exposure, electrons); });
        if (i > 0) with_ms = std::min(with_ms, with), without_ms = std::min(without_ms, plain);
    }
    out.ms = with_ms - without_ms;
    out.resolved_ms = 0.05 * with_ms;
    return out;
}

std::optional<FrameTime> frame_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures) {
    const ScenarioConfig& s = station.scenario();
    if (primary_rays(s, render_quality_of(s)) > kMaxTrialRays) return {};
    TrialFrames frames({exposures, station.chain(), world, s, seed_of_camera(s, station.number() - 1)});
    std::vector<double> render_ms, sensor_ms;
    frames.take();
    for (int i = 0; i < kFrames; ++i) {
        const TrialCost cost = frames.take();
        render_ms.push_back(cost.render_ms);
        sensor_ms.push_back(cost.sensor_ms);
    }
    return FrameTime{
        median(render_ms), median(sensor_ms),
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))};
}

}  // namespace hilcam
