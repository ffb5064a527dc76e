#include "emulator/zoo/zoo_errors.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

double at(const ElectronImage& image, std::size_t i) { return static_cast<double>(image.data()[i]); }

// Returns the reference's standard error near a pixel [e-]: the rms over 3 x 3 pixels, because the estimate
// for one pixel is often near 0 by chance.
double error_about(const ElectronImage& error, std::size_t i) {
    const auto width = static_cast<std::size_t>(error.width());
    const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
    double squares = 0;
    int count = 0;
    for (int v = std::max(0, y - 1); v <= std::min(error.height() - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(error.width() - 1, x + 1); ++u) {
            const auto e = static_cast<double>(error.row(v)[static_cast<std::size_t>(u)]);
            squares += e * e, ++count;
        }
    return std::sqrt(squares / count);
}

// Counts pixels of `bright` that shine where `dim` does not, like false_lights() of image_error.h, but above
// five times both the noise and the reference's own error.
double lights_of_one_alone(const ElectronImage& bright, const ElectronImage& dim,
                           const ZooReference& reference, const SensorNoise& noise) {
    constexpr double kMin_sigma = 5, kMaxDim_e = 100;
    double count = 0;
    for (std::size_t i = 0; i < dim.pixels(); ++i) {
        const double dark_e = at(reference.dark, i), dim_e = at(dim, i);
        if (dim_e - dark_e >= kMaxDim_e) continue;
        const double excess_e = at(bright, i) - dim_e;
        if (excess_e <= kMin_sigma * noise.sigma_e(dim_e, dark_e)) continue;
        const double known_e = error_about(reference.error, i);
        if (excess_e > kMin_sigma * std::hypot(noise.sigma_e(dim_e, dark_e), known_e)) ++count;
    }
    return count;
}

// Returns errors on smooth surface in units of sensor noise, for grid_energy().
std::vector<float> errors_in_noise(const ElectronImage& picture, const ZooReference& reference,
                                   const SensorNoise& noise) {
    std::vector<float> out(picture.pixels());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<float>((at(picture, i) - at(reference.mean, i)) /
                                    noise.sigma_e(at(reference.mean, i), at(reference.dark, i)));
    return out;
}

}  // namespace

ZooFigures zoo_errors(const ZooFrame& frame, const ZooReference& reference, const SurfacePixels& surface,
                      const SensorNoise& noise, ZooPixels& pixels) {
    const KnownPicture known{reference.mean, reference.dark, reference.error};
    ZooPixels own;
    for (std::size_t i = 0; i < frame.still.pixels(); ++i) {
        if (surface.near_object[i] == 0) continue;
        const double dark_e = at(reference.dark, i), mean_e = at(reference.mean, i);
        if (std::max(at(frame.still, i), mean_e) - dark_e <= noise.sigma_e(dark_e, dark_e)) continue;
        const double sigma_e = noise.sigma_e(mean_e, dark_e);
        own.errors.push_back(std::abs(at(frame.still, i) - mean_e) / sigma_e);
        own.reference_errors.push_back(std::abs(at(reference.error, i)) / sigma_e);
    }
    ZooFigures out;
    set_errors(own, out);
    pixels.errors.insert(pixels.errors.end(), own.errors.begin(), own.errors.end());
    pixels.reference_errors.insert(pixels.reference_errors.end(), own.reference_errors.begin(),
                                   own.reference_errors.end());
    out.blocks = block_counts(frame.still, known, surface, noise);
    const std::vector<float> errors = errors_in_noise(frame.still, reference, noise);
    out.grid = grid_energy({surface.width, surface.height, errors, surface.smooth});
    out.pan = pan_change({frame.still, frame.panned}, known, {reference.change, reference.change_error},
                         surface, noise);
    out.false_lights = lights_of_one_alone(frame.still, reference.mean, reference, noise);
    out.lost_lights = lights_of_one_alone(reference.mean, frame.still, reference, noise);
    return out;
}

void set_errors(const ZooPixels& pixels, ZooFigures& figures) {
    figures.error = noise_error(pixels.errors);
    figures.reference = noise_error(pixels.reference_errors);
    const double own = figures.reference.rms;
    figures.error_rms = std::sqrt(std::max(0.0, figures.error.rms * figures.error.rms - own * own));
}

}  // namespace hilcam
