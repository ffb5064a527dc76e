#pragma once
// The way of an object's vertices to the screen: the numbers that the loops of visibility_raster.h and rolling_raster.h take, from where the
// object is in the camera's axes. They are worked out in double precision. Loop, any thread.

#include "render/visibility/lens_tiles.h"
#include "render/visibility/rolling_raster.h"
#include "render/visibility/row_poses.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

// An object in the camera's axes, at an instant.
struct InCamera {
    Mat3d camera_from_body;
    Vec3d origin_m;
};

// radius_m: of the sphere about the body's origin that holds the object. depth_origin_m: see ScreenProjection.
ScreenProjection screen_projection(const ImageGeometry& geometry, const InCamera& at, double radius_m,
                                   double depth_origin_m);

// An object at the instants of the picture's upper edge, its middle and its lower edge.
struct InRollingCamera {
    InCamera first, middle, last;
};
RollingProjection rolling_projection(const ImageGeometry& geometry, const InRollingCamera& at,
                                     double depth_origin_m);
// Returns how far places that roll_vertices() finds may be off while nothing moves by more than speed_px from row to row [px]: by the third
// power of the turn, which its polynomials leave out and which is 1/15.6 of it at most between three places where they are right (the least
// remainder of degree three), by that of a turn and a way together, and by rounding.
float rolling_margin_px(const ImageGeometry& geometry, const LensTiles::Slopes& slopes, const RowPoses& rows,
                        float speed_px);

}  // namespace hilcam
