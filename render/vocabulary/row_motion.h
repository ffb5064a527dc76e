#pragma once
// The motion of a camera whose rows are read one after the other: each row sees the world from the camera's
// pose at its own instant. The world itself stands still, at the frame's time.

#include "render/vocabulary/pose.h"

namespace hilcam {

struct RowMotion {
    Motion camera;           // at the frame's time; its velocity is relative to what it sees
    double line_time_s = 0;  // from one row to the next
    double middle_px = 0;    // place down the picture [px] that is read at the frame's time

    // Returns the camera's pose when a place down the picture is read; the middle of row i is at i + 0.5.
    // Loop, any thread.
    Pose pose_at(double y_px) const {
        const double dt_s = (y_px - middle_px) * line_time_s;
        return propagate(camera, camera.time + to_ns(dt_s));
    }
};

}  // namespace hilcam
