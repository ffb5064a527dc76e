#pragma once
// The section `quality`: what is traded of speed against accuracy.

#include <cstdint>

#include "render/frame/render_quality.h"
#include "render/vocabulary/config_field.h"
#include "sensor/exposure.h"

namespace hilcam {

// The part of the world's motion that is shown while the shutter is open (exposure_renderer.h).
enum class MotionQuality { kOff, kFast, kExact };

// The way in which the picture gets its point spread function. kAuto: by a compact kernel where that is as accurate
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
// Returns how the radiance images of that quality are made.
SensorSampling sampling_of(const QualityConfig& quality);

}  // namespace hilcam
