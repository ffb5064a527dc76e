#pragma once
// The section `more_cameras`: cameras in addition to a scenario's first.

#include <cstddef>
#include <cstdint>

#include "emulator/scenario/attitude_keys.h"
#include "emulator/scenario/outputs.h"
#include "render/vocabulary/config_field.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Largest number of cameras in a bench: telemetry numbers them from 1 in one byte.
inline constexpr std::size_t kMaxCameras = 255;

// An additional camera on the same body or on an object: for a stereo pair, or a star tracker.
struct CameraConfig {
    CameraModel camera;
    Vec3d position_m;  // mount's place in the body that carries it
    AttitudeForms attitude;
    std::int64_t thing = 0;
    OutputsConfig outputs;
};
Fields fields(CameraConfig& camera);
void validate(const CameraConfig& camera);

}  // namespace hilcam
