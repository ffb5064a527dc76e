#include "emulator/run/trial_frames.h"

#include "emulator/loop/shutter_timing.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/stopwatch.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {

double primary_rays(const ScenarioConfig& s, const RenderQuality& quality) {
    const double across =
        static_cast<double>(s.quality.oversampling) * static_cast<double>(quality.samples_per_axis);
    return static_cast<double>(s.camera.width_px) * static_cast<double>(s.camera.height_px) * across * across;
}

TrialFrames::TrialFrames(const Parts& parts)
    : parts_(parts),
      start_(parse_utc(parts.scenario.time_utc)),
      radiance_(parts.exposures.make_image()),
      exposure_{ShutterTiming(parts.scenario.camera).exposure_s(parts.scenario.camera.exposure_s),
                parts.scenario.camera.gain_db,
                {},
                {}} {
    points_.reserve(parts.exposures.max_points());
    ExposureRenderer::reserve_beside(beside_);
    const auto [array_width, array_height] = array_size(parts.scenario.camera);
    electrons_ = ElectronImage(array_width, array_height);
    const auto [width, height] = frame_size(parts.scenario.camera);
    frame_ = DnImage(width, height);
}

TrialCost TrialFrames::take() {
    const RandomKey key{parts_.seed, taken_++};
    const std::int64_t processor_begun_ns = processor_ns();
    const Stopwatch rendering;
    parts_.exposures.render(parts_.world, start_, key, radiance_, points_, exposure_);
    parts_.exposures.look_beside(beside_);
    TrialCost cost;
    cost.render_ms = rendering.ms();
    const Stopwatch sensing;
    parts_.chain.expose(radiance_, points_, exposure_, electrons_, beside_);
    parts_.chain.digitise(electrons_, exposure_, key, frame_);
    cost.sensor_ms = sensing.ms();
    cost.core_ms = static_cast<double>(processor_ns() - processor_begun_ns) * 1e-6;
    return cost;
}

}  // namespace hilcam
