#pragma once
// How far one picture of mean charge is from another of the same scene, in terms that flight software feels.
// All of them [e-], of the read-out array, without noise; `dark` is what they hold without light.

#include <optional>

#include "render/vocabulary/image.h"
#include "render/vocabulary/pixel_box.h"
#include "sensor/sensor_noise.h"

namespace hilcam {

// |difference| / sigma, sigma the sensor noise of the reference's pixel (sensor_noise.h), over lit pixels:
// those that are above their dark charge, in the one picture or the other, by more than the noise in the
// dark.
struct NoiseError {
    double p99 = 0;  // 99 % of the lit pixels are not farther off
    double rms = 0;
    double within_half_fraction = 1;  // of lit pixels: off by half their noise or less
    std::size_t lit_px = 0;           // without any, the figures above are as of equal pictures
};
NoiseError noise_error(const ElectronImage& image, const ElectronImage& reference, const ElectronImage& dark,
                       const SensorNoise& noise);

// Images do not copy by themselves. Owner thread.
ElectronImage clone(const ElectronImage& image);
// Charge above a level, which no frame shows, taken off. Owner thread.
void saturate(ElectronImage& image, double full_e);

// The light of a window of the array: all that is above the dark charge, whatever it comes from.
struct WindowLight {
    double total_e = 0;
    double x_px = 0, y_px = 0;  // its centre; the middle of pixel (0, 0) is at (0.5, 0.5)
};
// None where there is no light.
std::optional<WindowLight> window_light(const ElectronImage& image, const ElectronImage& dark,
                                        const PixelBox& window);

}  // namespace hilcam
