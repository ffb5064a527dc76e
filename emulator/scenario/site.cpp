#include "emulator/scenario/site.h"

#include <algorithm>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

bool is_local(const MotionConfig& m) {
    return m.frame == MotionFrame::kLocal || m.attitude.frame == MotionFrame::kLocal;
}

// Returns the key of the first thing in local axes, or an empty text.
std::string first_local_key(const ScenarioConfig& s) {
    if (s.camera_pose.frame == PoseConfig::Frame::kLocal) return "camera_pose.frame";
    if (s.camera_motion && is_local(*s.camera_motion)) return "camera_motion.frame";
    for (std::size_t i = 0; i < s.objects.size(); ++i) {
        const std::string object = "objects." + std::to_string(i);
        if (s.objects[i].pose.frame == PoseConfig::Frame::kLocal) return object + ".pose.frame";
        if (s.objects[i].motion && is_local(*s.objects[i].motion)) return object + ".motion.frame";
    }
    return "";
}

// Refuses rates of things that point at another body, because they turn as it moves.
void check_rates(const ScenarioConfig& s, BodyId site_body) {
    const auto check = [&](const PoseConfig& pose, const std::string& key) {
        if (pose.frame == PoseConfig::Frame::kLocal && pose.has_rate && pose.has_nadir_of &&
            pose.nadir_of != site_body)
            throw KeyError(
                key,
                "has no effect when nadir points to another body than the site's; accepted: no 'rate_deg_s'");
    };
    check(s.camera_pose, "camera_pose.rate_deg_s");
    for (std::size_t i = 0; i < s.objects.size(); ++i)
        check(s.objects[i].pose, "objects." + std::to_string(i) + ".pose.rate_deg_s");
}

std::string body_name(BodyId id) { return std::string(kBodyNames[index_of(id)]); }

}  // namespace

std::optional<PlaceConfig> site_of(const ScenarioConfig& s) {
    if (s.site) return s.site;
    if (s.terrain && s.terrain->place) return s.terrain->place;
    if (s.origin.turns()) return PlaceConfig{*s.origin.center(), s.origin.place};
    return {};
}

bool uses_local_axes(const ScenarioConfig& s) { return !first_local_key(s).empty(); }

void check_site(const ScenarioConfig& s) {
    const std::string key = first_local_key(s);
    if (key.empty()) return;
    const std::optional<PlaceConfig> site = site_of(s);
    if (!site)
        throw refused_key(key, "'local', and no site for its axes",
                          "with site: {body, longitude_deg, latitude_deg}, terrain.place, or an origin of "
                          "kind earth_fixed or body_fixed");
    check_rates(s, site->body);
    if (s.origin.center() == site->body) return;
    const std::string body = body_name(site->body);
    throw KeyError(
        key, "found 'local' at a site on the body " + in_quotes(body) + ", and an origin " +
                 (s.origin.center() ? "at " + in_quotes(body_name(*s.origin.center()))
                                    : std::string("in free space")) +
                 "; accepted: an origin on the site's body, as origin: {kind: body_center, body: " + body +
                 "}");
}

PlacedFrame local_frame(const PlaceConfig& site) {
    PlacedFrame frame;
    frame.kind = PlacedFrame::Kind::kLocal;
    frame.center = {site.body};
    frame.site = site.place;
    return frame;
}

MotionConfig local_motion(const PoseConfig& pose, const PlaceConfig& site) {
    MotionConfig out;
    out.frame = MotionFrame::kLocal;
    out.position_m = pose.position_m, out.velocity_m_s = pose.velocity_m_s;
    AttitudeConfig& attitude = out.attitude;
    attitude.frame = MotionFrame::kLocal;
    attitude.rate_body_rad_s = pose.rate_body_rad_s;
    switch (attitude_of(pose)) {
        case PoseConfig::Attitude::kQuaternion:
            attitude.attitude = pose.forms;
            if (pose.forms.has_radec) attitude.frame = MotionFrame::kWorld;
            return out;
        case PoseConfig::Attitude::kLookAt:
            attitude.attitude.wxyz = look_along(pose.look_at_m - pose.position_m, pose.up);
            return out;
        case PoseConfig::Attitude::kNadir:
            break;
    }
    if (pose.has_nadir_of && pose.nadir_of != site.body) {
        attitude.law = AttitudeConfig::Law::kNadir;
        attitude.nadir_of = index_of(pose.nadir_of), attitude.has_nadir_of = true;
        return out;
    }
    const Vec3d to_center_m =
        -(transposed(body_fixed_from_local(site.place)) * body_fixed_position_m(site.body, site.place)) -
        pose.position_m;
    attitude.attitude.wxyz = look_along(to_center_m, Vec3d{0, 1, 0});
    return out;
}

Motion local_motion_at(const PoseConfig& pose, const PlaceConfig& site, TimeTai time,
                       const OriginConfig& origin) {
    const MotionConfig local = local_motion(pose, site);
    const WorldFrame frame(time, origin);
    const PlacedAxes axes = axes_of(local_frame(site), {frame, {}});
    const StateVector state = world_state(axes, {local.position_m, local.velocity_m_s});
    AttitudeState attitude{frame_from_body(local.attitude.attitude), local.attitude.rate_body_rad_s};
    if (local.attitude.frame == MotionFrame::kLocal) attitude = world_attitude(axes.axes, attitude);
    return {time, {state.position_m, attitude.world_from_body}, state.velocity_m_s, attitude.rate_body_rad_s};
}

}  // namespace hilcam
