#pragma once
// Measures how far one picture of mean charge is from another of the same scene, in terms that matter to
// flight software. Pictures are in e-, as large as the read-out array, without noise; `dark` is the charge
// without light.

#include <optional>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/pixel_box.h"
#include "sensor/sensor_noise.h"

namespace hilcam {

// Statistics of |difference| / sigma over lit pixels. sigma: sensor noise of the reference's pixel
// (sensor_noise.h). A pixel is lit if its light in either picture exceeds the noise in the dark.
struct NoiseError {
    double p99 = 0;  // 99 % of the lit pixels are at most this far off
    double rms = 0;
    double within_half_fraction = 1;  // share of lit pixels that are off by at most half their noise
    std::size_t lit_px = 0;           // without lit pixels, the figures above are those of equal pictures
};
NoiseError noise_error(const ElectronImage& image, const ElectronImage& reference, const ElectronImage& dark,
                       const SensorNoise& noise);

// The same for single pixels, to combine several pictures: |image - other| / sigma of the pixels that are lit
// in any of the pictures. sigma: sensor noise of the pixel in `truth`.
struct ComparedPictures {
    const ElectronImage& image;
    const ElectronImage& other;
    const ElectronImage& truth;
    const ElectronImage& dark;
};
std::vector<double> lit_errors(const ComparedPictures& pictures, const SensorNoise& noise);
NoiseError noise_error(std::vector<double> lit_errors);

// Counts pixels that shine where nothing should: more than 5 sigma above the reference, where the reference
// has less than 100 e- of light above its dark charge.
std::size_t false_lights(const ElectronImage& image, const ElectronImage& reference,
                         const ElectronImage& dark, const SensorNoise& noise);

// Copies an image, as images have no copy constructor. Owner thread.
ElectronImage clone(const ElectronImage& image);
// Cuts off charge above a level that frames cannot show. Owner thread.
void saturate(ElectronImage& image, double full_e);

// All light in a window of the array above the dark charge, whatever its source.
struct WindowLight {
    double total_e = 0;
    double x_px = 0, y_px = 0;  // centroid; the centre of pixel (0, 0) is (0.5, 0.5)
};
// Returns nothing when there is no light.
std::optional<WindowLight> window_light(const ElectronImage& image, const ElectronImage& dark,
                                        const PixelBox& window);

}  // namespace hilcam
