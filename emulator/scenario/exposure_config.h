#pragma once
// The parts of a scenario that the rendering of an exposure needs, in addition to the camera's data sheet
// (emulator/loop/exposure_renderer.h).

#include <cstdint>

#include "emulator/scenario/quality_config.h"
#include "render/vocabulary/time.h"
#include "sensor/exposure.h"

namespace hilcam {

struct ScenarioConfig;

struct ExposureConfig {
    MotionQuality motion = MotionQuality::kFast;
    double motion_error_px = 0.25;
    SensorSampling sampling;    // sampling of the radiance images at all quality levels
    bool for_detector = false;  // true: pictures are charge rates of the detector's channels; false: radiance
    bool has_terrain = false;  // true: rows exposed one after the other move across the ground, not an object
    std::uint64_t seed = 1;    // seed and start determine the pointing jitter
    TimeTai start;
};
ExposureConfig exposure_config_of(const ScenarioConfig& scenario);

}  // namespace hilcam
