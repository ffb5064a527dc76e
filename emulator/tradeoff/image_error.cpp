#include "emulator/tradeoff/image_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/vocabulary/check.h"

namespace hilcam {

std::vector<double> lit_errors(const ComparedPictures& p, const SensorNoise& noise) {
    HILCAM_CHECK(p.image.pixels() == p.other.pixels() && p.image.pixels() == p.truth.pixels() &&
                 p.image.pixels() == p.dark.pixels());
    std::vector<double> errors;
    for (std::size_t i = 0; i < p.image.pixels(); ++i) {
        const auto dark_e = static_cast<double>(p.dark.data()[i]);
        const auto one_e = static_cast<double>(p.image.data()[i]),
                   other_e = static_cast<double>(p.other.data()[i]);
        const auto true_e = static_cast<double>(p.truth.data()[i]);
        if (std::max({one_e, other_e, true_e}) - dark_e <= noise.sigma_e(dark_e, dark_e)) continue;
        errors.push_back(std::abs(one_e - other_e) / noise.sigma_e(true_e, dark_e));
    }
    return errors;
}

NoiseError noise_error(std::vector<double> errors) {
    if (errors.empty()) return {};
    double squares = 0;
    std::size_t within = 0;
    for (const double error : errors) {
        squares += error * error;
        if (error <= 0.5) ++within;
    }
    const auto count = static_cast<double>(errors.size());
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * count)) - 1;
    std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
    return {errors[static_cast<std::size_t>(rank)], std::sqrt(squares / count),
            static_cast<double>(within) / count, errors.size()};
}

NoiseError noise_error(const ElectronImage& image, const ElectronImage& reference, const ElectronImage& dark,
                       const SensorNoise& noise) {
    return noise_error(lit_errors({image, reference, reference, dark}, noise));
}

std::size_t false_lights(const ElectronImage& image, const ElectronImage& reference,
                         const ElectronImage& dark, const SensorNoise& noise) {
    HILCAM_CHECK(image.pixels() == reference.pixels() && image.pixels() == dark.pixels());
    // Far enough above the noise that the reference's scatter causes none, and dim enough that edges in a
    // frame cause none.
    constexpr double kMin_sigma = 5, kMaxTrue_e = 100;
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto dark_e = static_cast<double>(dark.data()[i]),
                   true_e = static_cast<double>(reference.data()[i]);
        if (true_e - dark_e >= kMaxTrue_e) continue;
        const double excess_e = static_cast<double>(image.data()[i]) - true_e;
        if (excess_e > kMin_sigma * noise.sigma_e(true_e, dark_e)) ++count;
    }
    return count;
}

ElectronImage clone(const ElectronImage& image) {
    ElectronImage out(image.width(), image.height());
    std::copy(image.all().begin(), image.all().end(), out.all().begin());
    return out;
}

void saturate(ElectronImage& image, double full_e) {
    const auto most = static_cast<float>(full_e);
    for (float& charge : image.all()) charge = std::min(charge, most);
}

std::optional<WindowLight> window_light(const ElectronImage& image, const ElectronImage& dark,
                                        const PixelBox& window) {
    WindowLight light;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            const auto i = static_cast<std::size_t>(x);
            const double e = static_cast<double>(image.row(y)[i]) - static_cast<double>(dark.row(y)[i]);
            light.total_e += e;
            light.x_px += (x + 0.5) * e;
            light.y_px += (y + 0.5) * e;
        }
    if (!(light.total_e > 0)) return std::nullopt;
    light.x_px /= light.total_e;
    light.y_px /= light.total_e;
    return light;
}

}  // namespace hilcam
