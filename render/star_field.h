#pragma once
// The stars that a frame shows, as point sources on the image.

#include <vector>

#include "render/background.h"
#include "render/embree_scene.h"
#include "render/path_tracer.h"
#include "render/point_source.h"

namespace hilcam {

// Appends every star that falls on the padded image and is hidden neither by an object nor by the Earth. A
// star just behind an edge is wholly there or wholly gone. Loop: allocates nothing while `points` has room
// for all stars.
void add_stars(const std::vector<Star>& stars, const FrameView& frame, std::vector<PointSource>& points);

}  // namespace hilcam
