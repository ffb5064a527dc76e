#pragma once
// `hilcam check --calibration`: the cameras as programs of computer vision take them: a pinhole with its
// distortion, and where each camera sits beside the first that is told.
//
// Those programs count pixels from the middle of the first one, which is (0, 0) for them and (0.5, 0.5) here:
// the principal point is told smaller by half a pixel. Axes are the same, +x right, +y down, +z along the
// boresight, and so are the polynomials of distortion (render/vocabulary/image_geometry.h). The frame is the
// camera's own, with its black columns and rows, binned as its file says, not mirrored.
//
// Not told: what changes with time or wavelength, and a rolling shutter's rows.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

enum class CalibrationFormat {
    kNone,
    kOpencv,  // YAML of OpenCV's FileStorage
    kRos,     // sensor_msgs/CameraInfo as camera_calibration_parsers reads it; one camera
    kKalibr,  // a camchain
};

struct CameraCalibration {
    std::size_t number = 1;  // on the bench, from 1
    std::string name;
    int width_px = 0, height_px = 0;
    Vec2d focal_length_px;
    Vec2d principal_point_px;  // the middle of the first pixel is (0, 0)
    LensDistortion distortion;
    // Rotation from the axes of the first camera that is told: p_own = rotation * p_first + translation_m.
    Mat3d own_from_first;
    Vec3d translation_m;
};

// camera: the one to tell, from 1; 0: all of the scenario. InputError where a camera is no pinhole, or where
// one rides on something else than the first that is told.
std::vector<CameraCalibration> calibrations_of(const ScenarioConfig& scenario, std::size_t camera);
// A camera's file alone.
CameraCalibration calibration_of(const CameraModel& camera);

// InputError where the format has no place for what a camera does, or for more than one camera.
std::string calibration_text(std::span<const CameraCalibration> cameras, CalibrationFormat format);

}  // namespace hilcam
