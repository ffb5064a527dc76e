#pragma once
// Local axes of a scenario: x east, y north, z up along the ellipsoid's normal, at a site on a body, with
// which they turn.
//
// The site is `site`, or without it the place of the terrain, or of an origin that turns. It lies on the
// body that the origin belongs to: other bodies are drawn where their light shows them, tens of kilometres
// off the place where they are.

#include <optional>

#include "emulator/motion/placed_frame.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

std::optional<PlaceConfig> site_of(const ScenarioConfig& scenario);
// True when a pose or a motion of the scenario is in local axes.
bool uses_local_axes(const ScenarioConfig& scenario);
// Throws KeyError when local axes are used without a site, or one on another body than the origin's.
void check_site(const ScenarioConfig& scenario);

PlacedFrame local_frame(const PlaceConfig& site);
// A pose in local axes as a motion: it stands there, or goes with its velocity, and turns with the body.
MotionConfig local_motion(const PoseConfig& pose, const PlaceConfig& site);
// The same at an instant, in the world. What looks at another body than the site's has the attitude (1, 0, 0,
// 0) there: its source of motion has it right.
Motion local_motion_at(const PoseConfig& pose, const PlaceConfig& site, TimeTai time,
                       const OriginConfig& origin);

}  // namespace hilcam
