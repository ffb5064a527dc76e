#pragma once
// Points of light as a part of the picture (light_part.h): what pixels would have of them if a lens were sharp.

#include <span>

#include "render/shading/pixel_record.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/light_parts.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

// Adds to the part of points, for the pixel in which each lies, the radiance over all of it that brings the point's irradiance; and to a
// record, where it has the pixel. record: may be null.
void add_points_part(const ImageGeometry& geometry, std::span<const PointSource> points, LightParts& parts,
                     PixelRecord* record);

}  // namespace hilcam
