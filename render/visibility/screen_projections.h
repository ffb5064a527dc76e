#pragma once
// Computes, in double precision, the numbers by which the loops of visibility_raster.h and rolling_raster.h
// project an object's vertices to the screen. Loop, any thread.

#include "render/visibility/lens_tiles.h"
#include "render/visibility/rolling_raster.h"
#include "render/visibility/row_poses.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

// An object in camera axes at an instant.
struct InCamera {
    Mat3d camera_from_body;
    Vec3d origin_m;
};

// radius_m: of the sphere about the body's origin that holds the object. depth_origin_m: see
// ScreenProjection.
ScreenProjection screen_projection(const ImageGeometry& geometry, const InCamera& at, double radius_m,
                                   double depth_origin_m);

// An object at the instants of the picture's upper edge, middle and lower edge.
struct InRollingCamera {
    InCamera first, middle, last;
};
RollingProjection rolling_projection(const ImageGeometry& geometry, const InRollingCamera& at,
                                     double depth_origin_m);
// Returns the largest error of places from roll_vertices() while nothing moves by more than speed_px from row
// to row [px]. It has three terms: the third power of the turn, which the polynomials omit and which is at
// most 1/15.6 of it between three exact places (the least remainder of degree three); the product of a turn
// and a displacement; and rounding.
float rolling_margin_px(const ImageGeometry& geometry, const LensTiles::Slopes& slopes, const RowPoses& rows,
                        float speed_px);

}  // namespace hilcam
