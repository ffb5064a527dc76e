#pragma once
// What one exposure's rendering takes from a scenario, beside the camera's data sheet
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
    SensorSampling sampling;   // how the radiance images of all levels of quality are made
    bool has_terrain = false;  // rows that are lit one after the other pass the ground, not an object
    std::uint64_t seed = 1;    // of the pointing jitter, as is the next
    TimeTai start;
};
ExposureConfig exposure_config_of(const ScenarioConfig& scenario);

}  // namespace hilcam
