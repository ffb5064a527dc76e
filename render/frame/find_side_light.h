#pragma once
// Finds the light of the Sun and of bodies that comes from beside the picture: what a lens may scatter into it
// (sensor/stray/outside_light.h).
//
// The Sun's disk is taken as rings of points with its limb darkening, a body's cone as directions that are even
// over its solid angle, each with the radiance that a ray of the camera finds there. Directions that the padded
// image shows are left out: their light is in the image, and so is its glare. What stands in the way (bodies,
// their air, objects) is looked for by a ray each. Not found: light of objects, lamps, stars and points.

#include <vector>

#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/vocabulary/side_light.h"

namespace hilcam {

// Finds it for the frame that was placed last. lights: cleared first. Loop; nothing is allocated while there is room for
// kMaxSideLights; runs on oneTBB, and gives the same on any number of threads.
void find_side_light(const FrameContext& frame, const WorldSnapshot& world, std::vector<SideLight>& lights);

}  // namespace hilcam
