#pragma once
// The program's own ray generators (ray_generator.h).

#include <memory>

#include "render/shading/ray_generator.h"

namespace hilcam {

std::unique_ptr<RayGenerator> make_pinhole_rays();
// line_time_s: time from one row to the next.
std::unique_ptr<RayGenerator> make_rolling_rays(double line_time_s);
std::unique_ptr<RayGenerator> make_pushbroom_rays(double line_time_s);

}  // namespace hilcam
