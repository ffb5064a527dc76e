#pragma once
// Tests whether an event's condition holds in the world of a frame.
//
// Geometry uses origins and centres, and the Sun as a point. Light time is corrected only where bodies_at()
// corrects it. A place is in eclipse when the ellipsoid of a visible body (render/sky/bodies.h) is between it
// and the Sun's centre, as for the renderer. Bodies that the scenario does not show cast no eclipse.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emulator/events/event_config.h"
#include "render/scene/scene.h"

namespace hilcam {

// The things that conditions may name.
struct EventWorld {
    std::vector<std::string> objects;  // names of the objects, in their order
    std::array<bool, kBodyCount> visible{};
};

class EventCondition {
  public:
    // Throws InputError when the named object does not exist, or several have the name.
    EventCondition(const EventConditionConfig& config, const EventWorld& world);

    // True when the condition holds. Call it for one frame after the other: a condition that held before
    // keeps holding until it is exceeded by its margin.
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
