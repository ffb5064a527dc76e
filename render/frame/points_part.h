#pragma once
// Points of light as a part of the picture (light_part.h): the light that pixels would have with an ideally
// sharp lens.

#include <span>

#include "render/shading/pixel_record.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/light_parts.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

// Adds each point to the part of points: the pixel that holds it gets the radiance that, over its whole area,
// has the point's irradiance. Also adds it to the record if that has the pixel. record: may be null.
void add_points_part(const ImageGeometry& geometry, std::span<const PointSource> points, LightParts& parts,
                     PixelRecord* record);

}  // namespace hilcam
