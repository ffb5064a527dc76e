#pragma once
// From pixels to directions: a pinhole camera.
//
// Camera axes: +x right, +y down, +z along the boresight, which meets the image at its middle (width/2,
// height/2). The centre of pixel (0, 0) is at (0.5, 0.5) px. The guard band continues the image on all four
// sides: pixel (-1, 0) is seen too, so that light from outside the frame can spread in.

#include "render/vec.h"

namespace hilcam {

struct ImageGeometry {
    int width_px = 0;
    int height_px = 0;
    int guard_px = 0;            // on each side
    double focal_length_px = 0;  // focal length / pixel pitch

    int padded_width() const { return width_px + 2 * guard_px; }
    int padded_height() const { return height_px + 2 * guard_px; }
    // Not normalised: z = 1, so the same plane carries interpolation and projection. x, y in px of the sensor
    // frame.
    Vec3d direction_camera(double x_px, double y_px) const {
        return {(x_px - 0.5 * width_px) / focal_length_px, (y_px - 0.5 * height_px) / focal_length_px, 1.0};
    }
    // Where a direction with z > 0 meets the image [px of the sensor frame].
    Vec2d project_px(Vec3d direction_camera) const {
        return {0.5 * width_px + focal_length_px * direction_camera.x / direction_camera.z,
                0.5 * height_px + focal_length_px * direction_camera.y / direction_camera.z};
    }
};

}  // namespace hilcam
