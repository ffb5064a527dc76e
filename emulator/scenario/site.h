#pragma once
// Local axes of a scenario at a site on a body: x east, y north, z up along the ellipsoid's normal. They turn
// with the body.
//
// The site is `site`; without it, the place of the terrain, or of an origin on a turning body. It must be on
// the body of the origin, because other bodies are drawn at their apparent places, tens of kilometres from
// the true ones.

#include <optional>

#include "emulator/motion/placed_frame.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

std::optional<PlaceConfig> site_of(const ScenarioConfig& scenario);
// True when a pose or motion of the scenario uses local axes.
bool uses_local_axes(const ScenarioConfig& scenario);
// Throws KeyError when local axes are used without a site, or with a site on another body than the origin's.
void check_site(const ScenarioConfig& scenario);

PlacedFrame local_frame(const PlaceConfig& site);
// Turns a pose in local axes into a motion, at rest or at its velocity, that turns with the body.
MotionConfig local_motion(const PoseConfig& pose, const PlaceConfig& site);
// Returns the same at an instant, in the world. A pose that points at another body than the site's gets the
// attitude (1, 0, 0, 0) here; its motion source computes the right one.
Motion local_motion_at(const PoseConfig& pose, const PlaceConfig& site, TimeTai time,
                       const OriginConfig& origin);

}  // namespace hilcam
