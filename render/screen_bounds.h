#pragma once
// Which pixels a thing can cover: conservative boxes in padded pixels.

#include "render/path_tracer.h"

namespace hilcam {

// Of a box in body axes [m], least and greatest corner. The whole image when it reaches behind the camera.
PixelBox screen_bounds(const ImageGeometry& geometry, const Pose& camera, const Pose& object,
                       const std::array<Vec3d, 2>& bounds_m);
// Of a cone of directions around `axis_world` with half angle acos(cosine).
PixelBox screen_bounds_of_cone(const ImageGeometry& geometry, const Pose& camera, Vec3d axis_world,
                               double cosine);
// The smallest box around both; an empty one counts as nothing.
PixelBox merged(const PixelBox& a, const PixelBox& b);

}  // namespace hilcam
