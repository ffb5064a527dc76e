#include "emulator/motion/placed_frame.h"

namespace hilcam {

std::vector<MotionNeed> PlacedFrame::needs() const {
    std::vector<MotionNeed> needs;
    if (follows_thing()) needs.push_back({thing, false});
    if (kind == Kind::kThing) needs.push_back({thing, true});
    return needs;
}

StateVector about_center(const MotionContext& context, const StateVector& world, const OrbitCenter& center) {
    const StateVector middle = context.frame.center(center);
    return {world.position_m - middle.position_m, world.velocity_m_s - middle.velocity_m_s};
}

namespace {

PlacedAxes local_axes(BodyId body, const Geodetic& site, const WorldFrame& frame) {
    const StateVector middle = frame.center({body});
    const TurningAxes fixed = frame.body_fixed(body);
    const Vec3d arm = fixed.icrf_from_axes * body_fixed_position_m(body, site);
    return {{middle.position_m + arm, middle.velocity_m_s + cross(fixed.rate_rad_s, arm)},
            {fixed.icrf_from_axes * body_fixed_from_local(site), fixed.rate_rad_s}};
}

}  // namespace

PlacedAxes axes_of(const PlacedFrame& frame, const MotionContext& context) {
    if (frame.kind == PlacedFrame::Kind::kWorld) return {};
    if (frame.kind == PlacedFrame::Kind::kLocal)
        return local_axes(*frame.center.body, frame.site, context.frame);
    if (frame.kind == PlacedFrame::Kind::kBodyFixed) {
        if (!frame.center.body) return {context.frame.center(frame.center), {}};
        return {context.frame.center(frame.center), context.frame.body_fixed(*frame.center.body)};
    }
    const Motion& thing = context.things[frame.thing];
    const bool stands = context.stands(frame.thing);
    StateVector origin{thing.pose.position_world_m, thing.velocity_world_m_s};
    if (frame.kind == PlacedFrame::Kind::kLvlh) {
        TurningAxes axes = lvlh_axes(about_center(context, origin, frame.center));
        return stands ? PlacedAxes{{origin.position_m, {}}, {axes.icrf_from_axes, {}}}
                      : PlacedAxes{origin, axes};
    }
    if (stands) origin.velocity_m_s = {};
    const Mat3d axes = to_matrix(thing.pose.world_from_body);
    return {origin, {axes, axes * thing.rate_body_rad_s}};
}

StateVector world_state(const PlacedAxes& frame, const StateVector& s) {
    const Vec3d arm = frame.axes.icrf_from_axes * s.position_m;
    return {frame.origin.position_m + arm, frame.origin.velocity_m_s +
                                               frame.axes.icrf_from_axes * s.velocity_m_s +
                                               cross(frame.axes.rate_rad_s, arm)};
}

AttitudeState world_attitude(const TurningAxes& axes, const AttitudeState& a) {
    const Quat world_from_body = normalized(to_quat(axes.icrf_from_axes) * a.world_from_body);
    return {world_from_body, a.rate_body_rad_s + to_matrix(conjugate(world_from_body)) * axes.rate_rad_s};
}

}  // namespace hilcam
