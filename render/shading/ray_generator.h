#pragma once
// A ray generator turns pixels into the camera's rays; it is one of the program's exchangeable models.
//
//   pinhole    all pixels at one instant, with the lens's distortion
//   rolling    a pose per row: rows are read `line_time` after each other, the middle row at the frame's time
//   pushbroom  a line camera: every row of the image is the sensor's middle row, `line_time` apart

#include <span>

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/row_motion.h"

namespace hilcam {

// World axes. The origin counts from the camera's place at the frame's time.
struct CameraRay {
    Vec3d from_camera_m;
    Vec3d dir;  // direction of any length
};

// The place and form in which a thing too small for an image appears.
struct Sighting {
    Vec2d position_px;    // place in the frame, without the guard band
    Vec3d from_camera_m;  // the camera's place at that row's instant, from its place at the frame's time
    // Ratio of its light to that of a camera whose pixels stare at it for one exposure. Above 1 it is in view
    // of so many rows one after another.
    double light_ratio = 1;
};

// Directions corner + x right + y down, x and y in padded px; all from the camera's place.
struct LinearRays {
    Vec3d corner, right, down;
};

class RayGenerator {
  public:
    virtual ~RayGenerator() = default;

    // Once per frame; the camera's velocity is that against what it sees. Owner thread.
    virtual void place(const ImageGeometry& geometry, const Motion& camera) = 0;
    // The rays through points of the padded image [px]. Loop, any thread.
    virtual void generate(std::span<const Vec2d> points_px, std::span<CameraRay> rays) const = 0;
    // Finds where the image shows what lies in a direction (unit, world, from the camera's place at the
    // frame's time) at a distance that may be infinite. False: nowhere. A place outside the image may be
    // given too. Rays of several instants look for the row that sees it; a thing that passes the field twice
    // is seen once. Loop, any thread.
    virtual bool find(Vec3d dir, double distance_m, Sighting& seen) const = 0;
    // Returns how far the boresight turns from its direction at the frame's time, at most [rad].
    virtual double sweep_rad() const { return 0; }
    // Rows of the image are instants of one row of the sensor, line_time_s apart; else 0.
    virtual double scan_line_time_s() const { return 0; }
    // Returns the linear form of the rays where all rays have it, else null. Placed with the frame.
    virtual const LinearRays* linear() const { return nullptr; }
    // All rays leave the camera at one instant and place, where project_px() says.
    virtual bool is_still() const { return true; }
    // Returns how the camera moves between rows where each row of the picture is a row of the sensor at an instant of its own, else
    // null. Placed with the frame.
    virtual const RowMotion* row_motion() const { return nullptr; }
};

}  // namespace hilcam
