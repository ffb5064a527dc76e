#pragma once
// A ray generator turns pixels into camera rays. It is one of the program's exchangeable models.
//
//     pinhole    all pixels at one instant, with the lens's distortion
//     rolling    one pose per row: rows are read `line_time` apart, the middle row at the frame's time
//     pushbroom  a line camera: each row of the image is the sensor's middle row, read `line_time` apart

#include <span>

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/row_motion.h"

namespace hilcam {

// A ray in world axes. Its origin is relative to the camera's position at the frame's time.
struct CameraRay {
    Vec3d from_camera_m;
    Vec3d dir;  // direction of any length
};

// The place and form in which a thing appears that is too small for an image.
struct Sighting {
    Vec2d position_px;    // in the frame, without the guard band
    Vec3d from_camera_m;  // the camera's position when that row is read, relative to that at the frame's time
    // Its light relative to that in a camera whose pixels look at it for one exposure. Above 1, it is in view
    // of that many rows in succession.
    double light_ratio = 1;
};

// Directions corner + x right + y down, with x and y in padded px; all from the camera's position.
struct LinearRays {
    Vec3d corner, right, down;
};

class RayGenerator {
  public:
    virtual ~RayGenerator() = default;

    // Called once per frame. The camera's velocity is relative to what it sees. Owner thread.
    virtual void place(const ImageGeometry& geometry, const Motion& camera) = 0;
    // Makes the rays through points of the padded image [px]. Loop, any thread.
    virtual void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const = 0;
    // Finds where the image shows a thing in a direction (unit, world, from the camera's position at the
    // frame's time) at a distance, which may be infinite. Returns false if it does not; may return places
    // outside the image. With rows of several instants it searches for the row that sees the thing; a thing
    // that passes the field twice is found once. Loop, any thread.
    virtual bool find(Vec3d dir, double distance_m, Sighting& seen) const = 0;
    // Returns the largest angle between the boresight and its direction at the frame's time [rad].
    virtual double sweep_rad() const { return 0; }
    // Returns the time between rows if all rows of the image are instants of one row of the sensor; otherwise
    // 0.
    virtual double scan_line_time_s() const { return 0; }
    // Returns the linear form of the rays if all rays have it, otherwise null. Placed with the frame.
    virtual const LinearRays* linear() const { return nullptr; }
    // True when all rays leave the camera at one instant and place, where project_px() says.
    virtual bool is_still() const { return true; }
    // Returns the camera's motion between rows if each row of the picture is a row of the sensor at its own
    // instant; otherwise null. Placed with the frame.
    virtual const RowMotion* row_motion() const { return nullptr; }
};

}  // namespace hilcam
