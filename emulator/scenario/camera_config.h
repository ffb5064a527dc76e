#pragma once
// The section `more_cameras`: cameras beside a scenario's first.

#include <cstddef>
#include <cstdint>

#include "emulator/scenario/attitude_keys.h"
#include "emulator/scenario/outputs.h"
#include "render/vocabulary/config_field.h"
#include "sensor/camera_model.h"

namespace hilcam {

// All of a bench: telemetry numbers them by a byte, from 1.
inline constexpr std::size_t kMaxCameras = 255;

// A camera beside the first, on the same body or on an object: a stereo pair, a star tracker.
struct CameraConfig {
    CameraModel camera;
    Vec3d position_m;  // its mount, where `attitude` is given
    AttitudeForms attitude;
    std::int64_t thing = 0;
    OutputsConfig outputs;
};
Fields fields(CameraConfig& camera);
void validate(const CameraConfig& camera);

}  // namespace hilcam
