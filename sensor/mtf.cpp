#include "sensor/mtf.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

double sinc(double x) {
    const double a = kPi * x;
    return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

double pupil_otf(double shift, double e, double defocus_waves) {
    const double s = std::abs(shift);
    if (s >= 2) return 0;
    // Two pupils shifted by -s/2 and +s/2 along x. At x they overlap for |y| < outer, minus the part where
    // the obscuration of either blocks |y| < inner. Their wavefronts differ by W20 ((x+s/2)^2 - (x-s/2)^2) =
    // 2 W20 s x.
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
    // Both halves in x and in y, divided by the area of the pupil.
    return 4 * sum * step / 3 / (kPi * (1 - e * e));
}

double aberration_mtf(double shift, double wavefront_rms_waves) {
    const double waves = wavefront_rms_waves / 0.18;
    const double from_middle = 0.5 * std::min(std::abs(shift), 2.0) - 0.5;
    return std::max(0.0, 1 - waves * waves * (1 - 4 * from_middle * from_middle));
}

double gaussian_mtf(double frequency_cy_px, double sigma_px) {
    const double a = kPi * frequency_cy_px * sigma_px;
    return std::exp(-2 * a * a);
}

double crosstalk_mtf(double u, double v, double fraction) {
    return 1 - 2 * fraction * (2 - std::cos(2 * kPi * u) - std::cos(2 * kPi * v));
}

double half_rays_mtf(double frequency_cy_px, RayGrid rays) {
    return sinc(frequency_cy_px / 2) / sinc(frequency_cy_px / -rays);
}

double ray_grid_mtf(double frequency_cy_px, RayGrid n) {
    if (is_halved(n)) return ray_grid_mtf(frequency_cy_px, -n);
    return n == kScatteredRays ? sinc(frequency_cy_px) : sinc(frequency_cy_px) / sinc(frequency_cy_px / n);
}

}  // namespace hilcam
