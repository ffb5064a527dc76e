#pragma once
// The part of a scenario that the rendering of one exposure takes, beside the camera's data sheet
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
    SensorSampling sampling;    // grid of the radiance images of all levels of quality
    bool for_detector = false;  // pictures are charge rates of the detector's channels, not radiance
    bool has_terrain = false;   // rows that are lit one after the other pass the ground, not an object
    std::uint64_t seed = 1;     // a figure of the pointing jitter, as is the next
    TimeTai start;
};
ExposureConfig exposure_config_of(const ScenarioConfig& scenario);

}  // namespace hilcam
