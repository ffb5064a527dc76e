#pragma once
// Focal length, principal point and distortion from pictures of a chessboard, with OpenCV's calib3d (Zhang, A
// flexible new technique for camera calibration, IEEE PAMI 22, 2000). The library is in a program of its own,
// hilcam-calibrate-lens (calibrate_lens.cpp), because it would bring hilcam three more libraries.
//
// k3 is 0 when the boards do not show it, below three of its standard deviations.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/clone/frame_set.h"
#include "sensor/camera_model.h"
#include "sensor/measure/frame_statistics.h"

namespace hilcam {

struct LensCalibration {
    Measured focal_length_px;
    Measured principal_x_px, principal_y_px;  // pixel centres at +0.5
    // Nothing: not seen, and 0.
    std::optional<Measured> k1, k2, p1, p2, k3;
    double residual_px = 0;     // root mean square over all corners
    double field_fraction = 0;  // greatest image height of a corner over that of the sensor's corner
    std::size_t boards = 0;
};

// linear: returns a frame of a series as numbers that are linear in light. Throws InputError, one line, for
// pictures without the board; DeviceError when hilcam-calibrate-lens is missing or fails.
using LinearFrame = std::function<std::vector<double>(const FrameSeries&, std::size_t)>;
LensCalibration calibrate_lens(const FrameSet& frames, const FrameSeries& series, const CameraModel& like,
                               const LinearFrame& linear);

}  // namespace hilcam
