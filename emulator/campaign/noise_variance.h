#pragma once
// The variance of each pixel's number from one taking of a picture to the next, as the sensor makes it [DN^2]:
// sensor/sensor_noise.h without its fixed patterns, at the mean charge that the picture's noise is drawn about.
//
// Not in it: noise of rendering (path models that draw their paths), defects, cosmic rays, filters of the
// electronics (they share noise along a row), what blooming or
// late charge brings, and the sharing of one row's noise. A pixel that is full, or whose number is the
// converter's last, has 0: it does not vary.

#include "render/vocabulary/image.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"

namespace hilcam {

using VarianceImage = Image<float, struct VarianceQuantity>;  // [DN^2], of the frame's size

// mean_e: mean electrons of the exposure, dark current in them, as SensorChain::expose() gives them. Throws
// InputError for a camera that bins numbers instead of charge, or whose numbers are not linear in it.
VarianceImage noise_variance(const CameraModel& camera, const ElectronImage& mean_e,
                             const Exposure& exposure);

}  // namespace hilcam
