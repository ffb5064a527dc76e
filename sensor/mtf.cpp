#include "sensor/mtf.h"

#include <algorithm>
#include <cmath>

#include "render/sun.h"
#include "render/units.h"
#include "sensor/optics.h"

namespace hilcam {

double sinc(double x) {
    const double a = kPi * x;
    return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

double pupil_otf(double shift, double e, double defocus_waves) {
    const double s = std::abs(shift);
    if (s >= 2) return 0;
    // Two pupils shifted by -s/2 and +s/2 along x. At x they overlap for |y| < outer, less where either one's
    // obscuration blocks |y| < inner. Their wavefronts differ by W20 ((x+s/2)^2 - (x-s/2)^2) = 2 W20 s x.
    const double reach = 1 - 0.5 * s;
    constexpr int kPieces = 2000;
    const double step = reach / kPieces;
    double sum = 0;
    for (int i = 0; i <= kPieces; ++i) {
        const double x = i * step;
        const double far = x + 0.5 * s;
        const double near = x - 0.5 * s;
        const double outer = std::sqrt(std::max(0.0, 1 - far * far));
        const double inner = std::sqrt(std::max(0.0, e * e - std::min(near * near, far * far)));
        const double factor = i == 0 || i == kPieces ? 1 : (i % 2 ? 4 : 2);
        sum += factor * std::max(0.0, outer - inner) * std::cos(2 * kPi * defocus_waves * 2 * s * x);
    }
    // Both halves in x and in y; over the area of the pupil.
    return 4 * sum * step / 3 / (kPi * (1 - e * e));
}

OpticsMtf::OpticsMtf(const CameraModel& c, const SpectralGrid& grid) {
    const Spectrum response = electrons_per_s_per_radiance(c, grid);
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    double total = 0;
    double shortest_um = grid.to_um(grid.size() - 1);
    for (int b = 0; b < grid.size(); ++b) {
        const double weight = static_cast<double>(response[b]) * static_cast<double>(sun[b]);
        total += weight;
        if (weight > 0) shortest_um = std::min(shortest_um, grid.center_um(b));
    }
    const auto shift_of = [&](double frequency_cy_px, double wavelength_um) {
        return 2 * frequency_cy_px / c.pitch_m * wavelength_um * 1e-6 * c.f_number;
    };
    cutoff_cy_px_ = 2 / shift_of(1.0, shortest_um);
    constexpr int kSteps = 512;
    table_.assign(kSteps + 2, 0.0);
    for (int i = 0; i <= kSteps; ++i) {
        const double frequency = cutoff_cy_px_ * i / kSteps;
        for (int b = 0; b < grid.size(); ++b) {
            const double weight = static_cast<double>(response[b]) * static_cast<double>(sun[b]) / total;
            if (!(weight > 0)) continue;
            const double w20_waves = c.defocus_m / (8 * c.f_number * c.f_number) / (grid.center_um(b) * 1e-6);
            table_[static_cast<std::size_t>(i)] += weight * pupil_otf(shift_of(frequency, grid.center_um(b)),
                                                                      c.central_obscuration_ratio, w20_waves);
        }
    }
}

double OpticsMtf::at(double frequency_cy_px) const {
    const double x = frequency_cy_px / cutoff_cy_px_ * static_cast<double>(table_.size() - 2);
    if (!(x < static_cast<double>(table_.size() - 2))) return 0;
    const auto i = static_cast<std::size_t>(x);
    const double u = x - static_cast<double>(i);
    return table_[i] + u * (table_[i + 1] - table_[i]);
}

double pixel_aperture_mtf(double frequency_cy_px, double fill_factor) {
    return sinc(frequency_cy_px * std::sqrt(fill_factor));
}

double ray_grid_mtf(double frequency_cy_px, int n) {
    return sinc(frequency_cy_px) / sinc(frequency_cy_px / n);
}

}  // namespace hilcam
