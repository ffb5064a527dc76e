#include "emulator/check/frame_time.h"

#include <tbb/global_control.h>

#include "emulator/loop/shutter_timing.h"
#include "emulator/scenario/quality_ladder.h"
#include "render/vocabulary/median.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

constexpr double kMaxRays = 32e6;
constexpr int kFrames = 3;

double primary_rays(const ScenarioConfig& s) {
    const double across = static_cast<double>(s.quality.oversampling) *
                          static_cast<double>(render_quality_of(s).samples_per_axis);
    return static_cast<double>(s.camera.width_px) * static_cast<double>(s.camera.height_px) * across * across;
}

template <class Work>
double milliseconds(const Work& work) {
    const Stopwatch watch;
    work();
    return watch.ms();
}

}  // namespace

std::optional<FrameTime> frame_time(CameraStation& station, WorldState& world, ExposureRenderer& exposures) {
    const ScenarioConfig& s = station.scenario();
    if (primary_rays(s) > kMaxRays) return {};
    const TimeTai start = parse_utc(s.time_utc);
    RadianceImage radiance = exposures.make_image();
    std::vector<PointSource> points;
    points.reserve(exposures.max_points());
    std::vector<SideLight> beside;
    const auto [array_width, array_height] = array_size(s.camera);
    ElectronImage electrons(array_width, array_height);
    const auto [width, height] = frame_size(s.camera);
    DnImage frame(width, height);
    Exposure exposure{ShutterTiming(s.camera).exposure_s(s.camera.exposure_s), s.camera.gain_db, {}, {}};
    std::vector<double> render_ms, sensor_ms;
    for (std::uint32_t i = 0; i <= kFrames; ++i) {
        const RandomKey key{seed_of_camera(s, station.number() - 1), i};
        const double render = milliseconds([&] {
            exposures.render(world, start, key, radiance, points, exposure);
            exposures.look_beside(beside);
        });
        const double sensor = milliseconds([&] {
            station.chain().expose(radiance, points, exposure, electrons, beside);
            station.chain().digitise(electrons, exposure, key, frame);
        });
        if (i == 0) continue;
        render_ms.push_back(render);
        sensor_ms.push_back(sensor);
    }
    return FrameTime{
        median(render_ms), median(sensor_ms),
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))};
}

}  // namespace hilcam
