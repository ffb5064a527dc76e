#pragma once
// A conservative box, in padded pixels, around the pixels that a body in the sky may cover.

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

// Returns the box of a cone of directions around `axis_world` with half angle acos(cosine).
PixelBox screen_bounds_of_cone(const ImageGeometry& geometry, const Pose& camera, Vec3d axis_world,
                               double cosine);

}  // namespace hilcam
