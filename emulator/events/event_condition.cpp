#include "emulator/events/event_condition.h"

#include <algorithm>
#include <cmath>

#include "render/sky/bodies.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// 0 to pi, right for small angles too (Kahan, How Futile are Mindless Assessments of Roundoff, 2006, 12).
}  // namespace

EventCondition::EventCondition(const EventConditionConfig& c, const EventWorld& world)
    : target_(target_named(c.object, world)),
      distance_m_{c.distance_m, c.margin_m},
      off_boresight_rad_{c.off_boresight_rad, c.margin_rad},
      sun_off_boresight_rad_{c.sun_off_boresight_rad, c.margin_rad},
      phase_rad_{c.phase_rad, c.margin_rad},
      light_(c.light),
      visible_(world.visible) {}

EventCondition::Target EventCondition::target_named(const std::string& name, const EventWorld& world) {
    if (name.empty()) return {};
    const auto count = std::count(world.objects.begin(), world.objects.end(), name);
    if (count > 1)
        throw InputError("object: " + in_quotes(name) + " is the name of " + std::to_string(count) +
                         " objects; accepted: a name that one has alone");
    const auto object = std::find(world.objects.begin(), world.objects.end(), name);
    if (object != world.objects.end())
        return {Target::Kind::kObject, static_cast<std::size_t>(object - world.objects.begin()), {}};
    if (name == "sun") return {Target::Kind::kSun, 0, {}};
    const auto body = std::find(kBodyNames.begin(), kBodyNames.end(), name);
    if (body != kBodyNames.end())
        return {Target::Kind::kBody, 0, static_cast<BodyId>(body - kBodyNames.begin())};
    std::string accepted;
    for (const std::string& o : world.objects) accepted += in_quotes(o) + ", ";
    throw refused("object", in_quotes(name), accepted + "sun, earth, moon, a planet");
}

Vec3d EventCondition::place_of(const WorldSnapshot& world) const {
    switch (target_.kind) {
        case Target::Kind::kObject:
            return world.objects[target_.object].position_world_m;
        case Target::Kind::kBody:
            return world.bodies[target_.body].world_m;
        case Target::Kind::kSun:
            return world.bodies.sun_world_m;
        case Target::Kind::kCamera:
            break;
    }
    return world.camera.position_world_m;
}

// A limit that held continues to hold until the value exceeds it by the margin.
bool EventCondition::Limits::hold(double value) {
    const double slack = held ? margin : 0;
    held = (!config.has_below || value < config.below + slack) &&
           (!config.has_above || value > config.above - slack);
    return held;
}

bool EventCondition::eclipsed(Vec3d place_m, const WorldSnapshot& world) const {
    const Vec3d to_sun_m = world.bodies.sun_world_m - place_m;
    const double sun_m = length(to_sun_m);
    if (!(sun_m > 0)) return false;
    for (std::size_t i = 0; i < kBodyCount; ++i) {
        const auto id = static_cast<BodyId>(i);
        const bool itself = target_.kind == Target::Kind::kBody && target_.body == id;
        if (!visible_[i] || itself) continue;
        const BodyState& body = world.bodies[id];
        const double away_m =
            intersect_ellipsoid(kFigures[i], body.fixed_from_world * (place_m - body.world_m),
                                body.fixed_from_world * (to_sun_m / sun_m));
        if (away_m > 0 && away_m < sun_m) return true;
    }
    return false;
}

bool EventCondition::holds(const WorldSnapshot& world) {
    const Vec3d place_m = place_of(world);
    const Vec3d way_m = place_m - world.camera.position_world_m;
    const Vec3d to_sun_m = world.bodies.sun_world_m - world.camera.position_world_m;
    const Vec3d boresight = to_matrix(world.camera.world_from_body) * Vec3d{0, 0, 1};
    // Evaluates all limits, so that each records whether it held.
    bool all = distance_m_.hold(length(way_m));
    all &=
        off_boresight_rad_.hold(off_boresight_rad_.config.given() ? angle_between_rad(boresight, way_m) : 0);
    all &= sun_off_boresight_rad_.hold(
        sun_off_boresight_rad_.config.given() ? angle_between_rad(boresight, to_sun_m) : 0);
    all &= phase_rad_.hold(
        phase_rad_.config.given() ? angle_between_rad(world.bodies.sun_world_m - place_m, -way_m) : 0);
    if (light_ != EventLight::kAny) all &= eclipsed(place_m, world) == (light_ == EventLight::kEclipsed);
    return all;
}

}  // namespace hilcam
