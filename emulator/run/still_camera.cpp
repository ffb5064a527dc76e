#include "emulator/run/still_camera.h"

#include <algorithm>

#include "emulator/loop/shutter_timing.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/world/clock.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

ImageGeometry image_geometry(const ScenarioConfig& s) {
    return geometry_of(s.camera, static_cast<int>(s.quality.guard_px),
                       static_cast<int>(s.quality.oversampling));
}

// Returns the exposure of the first frame that the camera would take.
Exposure first_exposure(const CameraModel& camera) {
    if (!camera.sequence.empty()) return {camera.sequence[0].exposure_s, camera.sequence[0].gain_db, {}, {}};
    return {ShutterTiming(camera).exposure_s(camera.exposure_s), camera.gain_db, {}, {}};
}

}  // namespace

StillCamera::StillCamera(const ScenarioConfig& scenario, double time_offset_s, Light light)
    : scenario_(scenario),
      light_(light),
      grid_(scenario.spectrum_edges_um),
      renderer_(load_renderer(scenario, grid_, image_geometry(scenario), &objects_)) {
    take(scenario, time_offset_s);
    radiance_ = exposures_->make_image();
    points_.reserve(exposures_->max_points());
}

void StillCamera::take(const ScenarioConfig& scenario, double time_offset_s) {
    scenario_ = scenario;
    const TimeTai start = parse_utc(scenario.time_utc);
    time_ = start + static_cast<std::int64_t>(time_offset_s * 1e9);
    snapshot_ = snapshot_at(scenario, start, time_);
    world_.emplace(initial_motions(scenario, start), scenario.origin, joints_of(scenario), scenario.mount,
                   load_motion_sources(scenario), lamp_mounts(scenario));
    ExposureConfig exposures = exposure_config_of(scenario);
    exposures.for_detector = light_ == Light::kCharge;
    exposures_.emplace(*renderer_, exposures, scenario.camera, grid_, world_->placed_objects());
    exposure_ = first_exposure(scenario.camera);
    renderer_->require_air(snapshot_);
}

void StillCamera::report(FrameTruth& truth) {
    renderer_->place_for_truth(snapshot_);
    renderer_->report_truth(truth);
}

// Uses central differences; their error is of third order.
Vec3d StillCamera::velocity_m_s(std::size_t object) {
    constexpr std::int64_t kStep_ns = 50'000'000;
    ShownCommand shown;
    WorldSnapshot before = snapshot_, after = snapshot_;
    world_->sample(time_, before, shown);
    world_->sample_again(time_ + -kStep_ns, false, before);
    world_->sample_again(time_ + kStep_ns, false, after);
    return (after.objects[object].position_world_m - before.objects[object].position_world_m) /
           (2e-9 * static_cast<double>(kStep_ns));
}

void StillCamera::look_from(const Pose& body) {
    const auto stand = [&](Vec3d velocity_world_m_s) {
        world_->set(0, {time_, body, velocity_world_m_s, {}}, {1, monotonic_ns()}, true);
        ShownCommand shown;
        world_->sample(time_, snapshot_, shown);
    };
    stand({});
    stand(world_->nearest_velocity_m_s(snapshot_));
    renderer_->require_air(snapshot_);
}

SensorChain& StillCamera::chain() {
    if (!chain_) {
        chain_.emplace(scenario_.camera, grid_, sampling_of(scenario_),
                       load_detector_pictures(scenario_.camera));
        const auto [array_width, array_height] = array_size(scenario_.camera);
        electrons_ = ElectronImage(array_width, array_height);
        const auto [width, height] = frame_size(scenario_.camera);
        frame_ = DnImage(width, height);
    }
    return *chain_;
}

const RadianceImage& StillCamera::render(RandomKey key, FrameTruth* truth) {
    exposures_->render(*world_, time_, key, radiance_, points_, exposure_, truth);
    exposures_->look_beside(beside_);
    return radiance_;
}

const ElectronImage& StillCamera::expose() {
    chain().expose(radiance_, points_, exposure_, electrons_, beside_);
    return electrons_;
}

const ElectronImage& StillCamera::expose_moved(int columns) {
    HILCAM_CHECK(columns >= 0 && columns < radiance_.width() &&
                 (!radiance_.moments() || !radiance_.moments()->used()));
    if (moved_.pixels() == 0) moved_ = exposures_->make_image();
    const auto shift = static_cast<std::ptrdiff_t>(columns);
    for (int plane = 0; plane < radiance_.planes(); ++plane)
        for (int y = 0; y < radiance_.height(); ++y) {
            const std::span<const float> from = radiance_.row(y, plane);
            const std::span<float> to = moved_.row(y, plane);
            std::fill(to.begin(), to.begin() + shift, from.front());
            std::copy(from.begin(), from.end() - shift, to.begin() + shift);
        }
    moved_points_ = points_;
    for (PointSource& point : moved_points_) point.position_px.x += static_cast<float>(columns);
    chain().expose(moved_, moved_points_, exposure_, electrons_, beside_);
    return electrons_;
}

const DnImage& StillCamera::digitise(RandomKey key) {
    chain().digitise(electrons_, exposure_, key, frame_);
    return frame_;
}

ElectronImage StillCamera::dark() {
    const auto [width, height] = array_size(scenario_.camera);
    ElectronImage out(width, height);
    const RadianceImage nothing = exposures_->make_image();
    chain().expose(nothing, {}, {exposure_.exposure_s, exposure_.gain_db}, out);
    return out;
}

}  // namespace hilcam
