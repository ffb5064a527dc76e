#pragma once
// Finds the light of the Sun and of bodies that reaches the lens from outside the picture and may be
// scattered into it (sensor/stray/outside_light.h).
//
// The Sun's disk is sampled by rings of points with its limb darkening. A body's cone is sampled by
// directions that are uniform over its solid angle, each with the radiance that a camera ray finds there.
// Directions inside the padded image are skipped, because their light and glare are in the image already. One
// ray per direction finds occlusion by bodies, their air, and objects. Not included: light of objects, lamps,
// stars and points.

#include <vector>

#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/vocabulary/side_light.h"

namespace hilcam {

// Finds the light for the frame that was placed last. lights: cleared first. Loop; no allocation while there
// is room for kMaxSideLights. Runs on oneTBB; the result does not depend on the number of threads.
void find_side_light(const FrameContext& frame, const WorldSnapshot& world, std::vector<SideLight>& lights);

}  // namespace hilcam
