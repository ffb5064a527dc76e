#include "emulator/zoo/zoo_camera.h"

#include <spdlog/fmt/fmt.h>

#include "emulator/bench/pilot.h"
#include "emulator/run/truth_source.h"
#include "emulator/zoo/surface_blocks.h"
#include "render/vocabulary/units.h"
#include "sensor/published_frame.h"

namespace hilcam {
namespace {

constexpr int kFewAround = 2, kAllAround = 6;
// Ratio of an inspection camera's exposures by the Earth's light alone and by the Sun's. In low orbits the
// Earth's light is some 6 to 12 % of the Sun's.
constexpr double kShadowExposure = 7;

bool can_be_turned(const ScenarioConfig& s) {
    return s.objects.size() == 1 && !s.objects.front().motion && !s.camera_motion && s.lamps.empty() &&
           !s.terrain && s.objects.front().pose.frame == PoseConfig::Frame::kWorld &&
           s.camera_pose.frame == PoseConfig::Frame::kWorld && s.mount.thing == 0;
}

std::vector<ZooShot> turned_shots(const StillCamera& camera, bool all_views) {
    const WorldSnapshot& world = camera.world();
    const Vec3d target_m = world.objects.front().position_world_m;
    const LightDirections light{normalized(world.bodies.sun_world_m - target_m),
                                normalized(world.bodies.earth().world_m - target_m)};
    const LoadedObject& object = camera.objects().front();
    std::vector<ZooShot> shots;
    for (const ZooView& view : zoo_views(all_views))
        shots.push_back({name_of(view),
                         stand_of(view, {object.min_m, object.max_m}, target_m, light),
                         is_shadow_side(view.light) ? kShadowExposure : 1,
                         {}});
    return shots;
}

std::vector<ZooShot> shots_around(const ScenarioConfig& s, const WorldSnapshot& world, bool all_views) {
    if (s.objects.empty()) return {{"own", {}, 1, {}}};
    CircleFlight flight = circle_around_target(s);
    if (s.camera_motion) flight.start_m = world.camera.position_world_m;
    if (s.objects.front().motion) flight.center_m = world.objects.front().position_world_m;
    const int count = all_views ? kAllAround : kFewAround;
    std::vector<ZooShot> shots;
    for (int i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / count;
        shots.push_back({fmt::format("{:.0f} deg", 360 * share),
                         {},
                         1,
                         flight.at(flight.period_s * share, parse_utc(s.time_utc)).pose});
    }
    return shots;
}

PoseConfig pose_of(const PoseConfig& own, Vec3d position_m, Quat attitude) {
    PoseConfig pose;
    pose.position_m = position_m;
    pose.forms.wxyz = attitude, pose.forms.has_wxyz = true;
    pose.has_attitude = false;
    pose.velocity_m_s = own.velocity_m_s, pose.rate_body_rad_s = own.rate_body_rad_s;
    pose.has_velocity = own.has_velocity, pose.has_rate = own.has_rate;
    return pose;
}

}  // namespace

std::vector<ZooShot> zoo_shots(const ScenarioConfig& scenario, const StillCamera& camera, bool all_views) {
    return can_be_turned(scenario) ? turned_shots(camera, all_views)
                                   : shots_around(scenario, camera.world(), all_views);
}

ScenarioConfig scenario_of_shot(const ScenarioConfig& scenario, const ZooShot& shot) {
    ScenarioConfig out = scenario;
    out.camera.exposure_s *= shot.exposure_factor;
    if (!shot.stand) return out;
    out.camera_pose = pose_of({}, shot.stand->camera.position_world_m, shot.stand->camera.world_from_body);
    out.has_camera_pose = true;
    PoseConfig& target = out.objects.front().pose;
    target = pose_of(target, target.position_m, shot.stand->world_from_target);
    out.objects.front().has_pose = true;
    return out;
}

std::vector<std::string> overrides_of_shot(const ScenarioConfig& scenario, const ZooShot& shot) {
    const auto pose_text = [](Vec3d p, Quat q) {
        return fmt::format("position_m: [{}, {}, {}], attitude_wxyz: [{}, {}, {}, {}]", p.x, p.y, p.z, q.w,
                           q.x, q.y, q.z);
    };
    std::vector<std::string> out;
    if (shot.exposure_factor != 1)
        out.push_back(
            fmt::format("camera.exposure_ms={}", 1e3 * scenario.camera.exposure_s * shot.exposure_factor));
    const std::optional<Pose> camera = shot.stand ? std::optional(shot.stand->camera) : shot.camera_body;
    if (camera)
        out.push_back(
            fmt::format("camera_pose={{{}}}", pose_text(camera->position_world_m, camera->world_from_body)));
    if (!shot.stand) return out;
    const PoseConfig& own = scenario.objects.front().pose;
    const Vec3d rate_deg_s = own.rate_body_rad_s / kDegree_rad;
    out.push_back(fmt::format("objects.0.pose={{{}, rate_deg_s: [{}, {}, {}]}}",
                              pose_text(own.position_m, shot.stand->world_from_target), rate_deg_s.x,
                              rate_deg_s.y, rate_deg_s.z));
    return out;
}

void ZooCamera::take(const ZooShot& shot) {
    shown_ = scenario_of_shot(scenario_, shot);
    camera_.take(shown_);
    if (shot.camera_body) camera_.look_from(*shot.camera_body);
}

std::optional<SurfacePixels> seen_surface(StillCamera& camera) {
    const ScenarioConfig& s = camera.scenario();
    if (s.camera.binning_x != 1 || s.camera.binning_y != 1) return {};
    TruthRequest request = truth_request(s);
    request.visibility = request.stars = false;
    request.object = request.part = request.normal = request.position = true;
    FrameTruth truth = make_truth(s, camera.renderer(), request);
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling), {});
    camera.report(truth);
    return surface_pixels(truth.layers);
}

}  // namespace hilcam
