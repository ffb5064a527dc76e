#pragma once
// The variance [DN^2] of each pixel's number between repeated exposures of the same picture. It follows the
// noise model of sensor/sensor_noise.h, without its fixed patterns, at the mean charge of the picture.
//
// Path models that draw random paths add rendering noise, which is measured (RenderingNoise) and added.
//
// Not included: defects, cosmic rays, filters of the electronics (they correlate noise along a row), charge
// from blooming or late transfer, and noise that a whole row shares. A pixel at full well, or at the
// converter's last number, has variance 0, because it does not vary.

#include <span>
#include <vector>

#include "render/vocabulary/image.h"
#include "sensor/camera_model.h"
#include "sensor/exposure.h"

namespace hilcam {

using VarianceImage = Image<float, struct VarianceQuantity>;  // [DN^2], as large as the frame

// The variance [e-^2] that random light paths cause in the mean electrons of each pixel, measured over
// several renderings of the same instant with different paths. Its relative error is sqrt(2 / (renderings -
// 1)).
class RenderingNoise {
  public:
    static constexpr int kRenderings = 16;

    // Adds a rendering's mean electrons. All renderings have the same size.
    void add(const ElectronImage& mean_e, const CameraModel& camera, const Exposure& exposure);
    // True when two of the renderings differ.
    bool is_random() const;
    // Returns an empty list before two renderings have been added.
    std::vector<double> variance_e2() const;

  private:
    int count_ = 0;
    std::vector<double> mean_, squares_;  // Welford's sums (Technometrics 4, 419, 1962)
};

// mean_e: mean electrons of the exposure including dark current, as SensorChain::expose() returns them.
// rendering_e2: variance from RenderingNoise; empty: rendering is not random. Throws InputError for a camera
// that bins numbers instead of charge, or for which numbers are not linear in charge.
VarianceImage noise_variance(const CameraModel& camera, const ElectronImage& mean_e, const Exposure& exposure,
                             std::span<const double> rendering_e2 = {});

}  // namespace hilcam
