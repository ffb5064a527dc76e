#pragma once
// Measures how far one picture of mean charge is from another of the same scene, in terms that flight
// software feels. All pictures are in e-, of the read-out array, without noise; `dark` is what they hold
// without light.

#include <optional>
#include <vector>

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
    double within_half_fraction = 1;  // share of lit pixels that are off by half their noise or less
    std::size_t lit_px = 0;           // without any, the figures above are as of equal pictures
};
NoiseError noise_error(const ElectronImage& image, const ElectronImage& reference, const ElectronImage& dark,
                       const SensorNoise& noise);

// The same pixel by pixel, to put several pictures together: |image - other| / sigma of the pixels that are
// lit in any of the pictures; sigma is that of the truth's pixel.
struct ComparedPictures {
    const ElectronImage& image;
    const ElectronImage& other;
    const ElectronImage& truth;
    const ElectronImage& dark;
};
std::vector<double> lit_errors(const ComparedPictures& pictures, const SensorNoise& noise);
NoiseError noise_error(std::vector<double> lit_errors);

// Pixels that shine where nothing does: more than 5 sigma above the reference (sigma as above), where that
// has less than 100 e- of light, which is what it has above its dark charge.
std::size_t false_lights(const ElectronImage& image, const ElectronImage& reference,
                         const ElectronImage& dark, const SensorNoise& noise);

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
