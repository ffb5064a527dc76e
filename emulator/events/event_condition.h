#pragma once
// Tests whether an event's condition holds in the world of a frame.
//
// Geometry: positions are origins and centres, the Sun is a point; no light time beyond what bodies_at() has.
// Eclipses: a visible body's ellipsoid (render/sky/bodies.h) lies between the place and the Sun's middle, as
// it does for the renderer; bodies that the scenario does not show hide nothing.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emulator/events/event_config.h"
#include "render/scene/scene.h"

namespace hilcam {

// The things that conditions can name.
struct EventWorld {
    std::vector<std::string> objects;  // by their order
    std::array<bool, kBodyCount> visible{};
};

class EventCondition {
  public:
    // Throws InputError when there is no such object, or several.
    EventCondition(const EventConditionConfig& config, const EventWorld& world);

    // Is asked of one frame after the other: what held before has a margin.
    bool holds(const WorldSnapshot& world);

  private:
    struct Limits {
        EventLimitsConfig config;
        double margin = 0;
        bool held = false;

        bool hold(double value);
    };
    struct Target {
        enum class Kind { kCamera, kObject, kBody, kSun } kind = Kind::kCamera;
        std::size_t object = 0;
        BodyId body = BodyId::kEarth;
    };
    static Target target_named(const std::string& name, const EventWorld& world);
    Vec3d place_of(const WorldSnapshot& world) const;
    bool eclipsed(Vec3d place_m, const WorldSnapshot& world) const;

    Target target_;
    Limits distance_m_, off_boresight_rad_, sun_off_boresight_rad_, phase_rad_;
    EventLight light_;
    std::array<bool, kBodyCount> visible_;
};

}  // namespace hilcam
