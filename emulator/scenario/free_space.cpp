#include "emulator/scenario/free_space.h"

#include <cmath>

namespace hilcam {
namespace {

void refuse_places(const SunConfig& sun) {
    for (const auto& [given, key] : {std::pair{sun.has_direction, "direction"},
                                     {sun.has_distance, "distance_au"},
                                     {sun.has_phase, "phase_deg"},
                                     {sun.has_azimuth, "azimuth_deg"}})
        if (given)
            throw KeyError(std::string("sun.") + key,
                           "has no effect: with this origin, time_utc gives the Sun's position; accepted: "
                           "origin: {kind: free}, or no '" +
                               std::string(key) + "'");
}

// At azimuth 90 and a phase angle below 90, sunlight comes from behind the camera's right shoulder.
Vec3d direction_by_phase(const ScenarioConfig& s) {
    const PoseConfig& pose = s.camera_pose;
    const bool fixed = !s.camera_motion && pose.frame == PoseConfig::Frame::kWorld &&
                       attitude_of(pose) != PoseConfig::Attitude::kNadir;
    if (!fixed)
        throw KeyError("sun.phase_deg",
                       "needs a camera_pose in the world's frame with look_at_m or an attitude of its own; "
                       "accepted: sun.direction with any motion");
    const Mat3d world_from_camera = to_matrix(initial_motion(pose, {}, {}).pose.world_from_body);
    const double sine = std::sin(s.sun.phase_rad);
    return world_from_camera * Vec3d{sine * std::sin(s.sun.azimuth_rad), -sine * std::cos(s.sun.azimuth_rad),
                                     -std::cos(s.sun.phase_rad)};
}

Vec3d sun_direction(const ScenarioConfig& s) {
    const SunConfig& sun = s.sun;
    if (sun.has_direction && sun.has_phase)
        throw refused_key("sun.phase_deg", "besides 'direction'", "one of them");
    if (sun.has_azimuth && !sun.has_phase)
        throw KeyError("sun.azimuth_deg",
                       "has no effect without 'phase_deg'; accepted: with it, or no "
                       "'azimuth_deg'");
    if (sun.has_phase) return direction_by_phase(s);
    if (!sun.has_direction)
        throw KeyError("sun",
                       "has no position of the Sun, which origin.kind free needs; accepted: sun.direction: "
                       "[x, y, z], or sun.phase_deg");
    if (!(length(sun.direction) > 0))
        throw refused_key("sun.direction", "a vector without a direction", "one that is not 0");
    return sun.direction;
}

// Refuses nadir in free space, because no body is near.
void check_nadir(const ScenarioConfig& s) {
    const auto check = [](const PoseConfig& pose, const std::string& key) {
        if (pose.attitude == PoseConfig::Attitude::kNadir && !pose.has_nadir_of)
            throw KeyError(key,
                           "is nadir in free space; accepted: nadir with nadir_of: a body's name, or "
                           "look_at_m");
    };
    check(s.camera_pose, "camera_pose.attitude");
    for (std::size_t i = 0; i < s.objects.size(); ++i)
        check(s.objects[i].pose, "objects." + std::to_string(i) + ".pose.attitude");
}

}  // namespace

void settle_free_space(ScenarioConfig& s) {
    if (s.origin.kind != OriginConfig::Kind::kFree) {
        refuse_places(s.sun);
        return;
    }
    check_nadir(s);
    s.origin.sun_m = s.sun.distance_m * normalized(sun_direction(s));
    for (BodyConfig& body : s.bodies)
        if (!body.has_visible) body.visible = false;
}

}  // namespace hilcam
