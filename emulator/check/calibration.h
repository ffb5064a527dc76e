#pragma once
// `hilcam check --calibration`: writes cameras for computer-vision programs, as a pinhole with distortion and
// its pose relative to the first camera written.
//
// Those programs put (0, 0) at the centre of the first pixel, which is (0.5, 0.5) here, so the written
// principal point is smaller by half a pixel. Axes are the same (+x right, +y down, +z along the boresight),
// and so are the distortion polynomials (render/vocabulary/image_geometry.h). The frame is the camera's own:
// with black columns and rows, binned as the file says, not mirrored.
//
// Not written: what depends on time or wavelength, and the row times of a rolling shutter.

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
    std::size_t number = 1;  // number on the bench, from 1
    std::string name;
    int width_px = 0, height_px = 0;
    Vec2d focal_length_px;
    Vec2d principal_point_px;  // in px; (0, 0) is the centre of the first pixel
    LensDistortion distortion;
    // Transforms points from the axes of the first camera written: p_own = own_from_first * p_first +
    // translation_m.
    Mat3d own_from_first;
    Vec3d translation_m;
};

// camera: which camera, from 1; 0: all cameras of the scenario. Throws InputError when a camera is not a
// pinhole, or when it rides on another object than the first one.
std::vector<CameraCalibration> calibrations_of(const ScenarioConfig& scenario, std::size_t camera);
// Returns the calibration of a camera file alone.
CameraCalibration calibration_of(const CameraModel& camera);

// Throws InputError when the format cannot express a camera's model, or more than one camera.
std::string calibration_text(std::span<const CameraCalibration> cameras, CalibrationFormat format);

}  // namespace hilcam
