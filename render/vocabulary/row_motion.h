#pragma once
// The motion of a camera whose rows are read one after the other: each row of the picture sees the world from a pose of its own. The
// world itself stands still meanwhile, as it is at the frame's time.

#include "render/vocabulary/pose.h"

namespace hilcam {

struct RowMotion {
    Motion camera;           // at the frame's time; its velocity is that against what it sees
    double line_time_s = 0;  // from one row to the next
    double middle_px = 0;    // place down the picture that is read at the frame's time

    // Returns the camera's pose at the instant of a place down the picture; the middle of row i is at i + 0.5. Loop, any thread.
    Pose pose_at(double y_px) const {
        const double dt_s = (y_px - middle_px) * line_time_s;
        return propagate(camera, camera.time + to_ns(dt_s));
    }
};

}  // namespace hilcam
