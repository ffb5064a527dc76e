#pragma once
// The variance of each pixel's number from one taking of a picture to the next, as the sensor makes it [DN^2]:
// sensor/sensor_noise.h without its fixed patterns, at the mean charge that the picture's noise is drawn about.
//
// Noise of rendering, by path models that draw their paths, is measured and added (RenderingNoise).
//
// Not in it: defects, cosmic rays, filters of the
// electronics (they share noise along a row), what blooming or
// late charge brings, and the sharing of one row's noise. A pixel that is full, or whose number is the
// converter's last, has 0: it does not vary.

#include <span>
#include <vector>

#include "render/vocabulary/image.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"

namespace hilcam {

using VarianceImage = Image<float, struct VarianceQuantity>;  // [DN^2], of the frame's size

// The variance that random light paths give the mean electrons of each pixel of the frame [e-^2], measured over
// some renderings of the same instant with other paths. Its own error is a share sqrt(2 / (renderings - 1)) of
// each pixel's.
class RenderingNoise {
  public:
    static constexpr int kRenderings = 16;

    // Adds a rendering's mean electrons; all are of one size.
    void add(const ElectronImage& mean_e, const CameraModel& camera, const Exposure& exposure);
    // True when two of them differ.
    bool is_random() const;
    // Empty while fewer than two were added.
    std::vector<double> variance_e2() const;

  private:
    int count_ = 0;
    std::vector<double> mean_, squares_;  // Welford's sums (Technometrics 4, 419, 1962)
};

// mean_e: mean electrons of the exposure, dark current in them, as SensorChain::expose() gives them. rendering_e2: as RenderingNoise has it;
// empty: nothing of the rendering is random. Throws
// InputError for a camera that bins numbers instead of charge, or whose numbers are not linear in it.
VarianceImage noise_variance(const CameraModel& camera, const ElectronImage& mean_e, const Exposure& exposure,
                             std::span<const double> rendering_e2 = {});

}  // namespace hilcam
