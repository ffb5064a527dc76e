#pragma once
// From pixels to the camera's rays: one of the program's exchangeable models.
//
//   pinhole    all pixels at one instant, with the lens's distortion
//   rolling    a pose per row: rows are read `line_time` after each other, the middle row at the frame's time
//   pushbroom  a line camera: every row of the image is the sensor's middle row, `line_time` apart

#include <span>

#include "render/image_geometry.h"
#include "render/pose.h"

namespace hilcam {

// World axes. The origin counts from the camera's place at the frame's time.
struct CameraRay {
    Vec3d from_camera_m;
    Vec3d dir;  // of any length
};

// Directions corner + x right + y down, x and y in padded px; all from the camera's place.
struct LinearRays {
    Vec3d corner, right, down;
};

class RayGenerator {
  public:
    virtual ~RayGenerator() = default;

    // Once per frame. Owner thread.
    virtual void place(const ImageGeometry& geometry, const Motion& camera) = 0;
    // The rays through points of the padded image [px]. Loop, any thread.
    virtual void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const = 0;
    // Where all rays are of that form; else null. Placed with the frame.
    virtual const LinearRays* linear() const { return nullptr; }
    // All rays leave the camera at one instant and place, where project_px() says.
    virtual bool is_still() const { return true; }
};

}  // namespace hilcam
