#include "render/sky/motion_bounds.h"

#include <cmath>

#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

std::string of_length(Vec3d v, const char* unit) {
    return is_finite(v) ? plain(std::hypot(v.x, v.y, v.z)) + unit : "that is no number";
}

}  // namespace

bool is_turn(Quat q) { return std::abs(norm(q) - 1) <= kNormTolerance; }

bool is_possible(const Pose& pose) {
    return is_within(pose.position_world_m, kFarthestPlace_m) && is_turn(pose.world_from_body);
}

bool is_possible(const Motion& m) {
    return is_possible(m.pose) && is_within(m.velocity_world_m_s, kFastestMotion_m_s) &&
           is_within(m.rate_body_rad_s, kFastestTurn_rad_s);
}

bool take_possible(const Motion& found, Motion& kept) {
    const Pose before = kept.pose;
    kept = found;
    if (is_possible(found)) return true;
    if (!is_within(found.velocity_world_m_s, kFastestMotion_m_s)) kept.velocity_world_m_s = {};
    if (!is_within(found.rate_body_rad_s, kFastestTurn_rad_s)) kept.rate_body_rad_s = {};
    if (!is_within(found.pose.position_world_m, kFarthestPlace_m))
        kept.pose.position_world_m = before.position_world_m, kept.velocity_world_m_s = {};
    if (!is_turn(found.pose.world_from_body))
        kept.pose.world_from_body = before.world_from_body, kept.rate_body_rad_s = {};
    return false;
}

std::string impossible_part(const Motion& m) {
    const Vec3d& place_m = m.pose.position_world_m;
    if (!is_within(place_m, kFarthestPlace_m))
        return "a place " + of_length(place_m, " m from the world's origin") + "; accepted: at most " +
               plain(kFarthestPlace_m) + " m from it";
    if (!is_within(m.velocity_world_m_s, kFastestMotion_m_s))
        return "a velocity " + of_length(m.velocity_world_m_s, " m/s") + "; accepted: at most " +
               plain(kFastestMotion_m_s) + " m/s";
    if (!is_turn(m.pose.world_from_body))
        return "an attitude that is no rotation; accepted: a quaternion of norm 1";
    if (!is_within(m.rate_body_rad_s, kFastestTurn_rad_s))
        return "a rate " + of_length(m.rate_body_rad_s, " rad/s") + "; accepted: at most " +
               plain(kFastestTurn_rad_s) + " rad/s";
    return {};
}

}  // namespace hilcam
