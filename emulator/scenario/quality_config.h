#pragma once
// The section `quality`: the choice between speed and accuracy.

#include <cstdint>

#include "render/frame/render_quality.h"
#include "render/vocabulary/config_field.h"
#include "sensor/exposure.h"

namespace hilcam {

// The rendering of the world's motion while the shutter is open (exposure_renderer.h).
enum class MotionQuality { kOff, kFast, kExact };

// The method that applies the point spread function. kAuto: by a compact kernel where that is as accurate
// (sensor/convolution/compact_kernel.h).
enum class PsfMethod { kAuto, kFft };

struct QualityConfig {
    RenderQuality render;
    std::int64_t guard_px = 28;
    std::int64_t oversampling = 1;
    PsfMethod psf = PsfMethod::kAuto;
    MotionQuality motion = MotionQuality::kFast;
    double motion_error_px = 0.25;
};
Fields fields(QualityConfig& quality);
void validate(const QualityConfig& quality);
// Returns how radiance images of that quality are sampled.
SensorSampling sampling_of(const QualityConfig& quality);

}  // namespace hilcam
