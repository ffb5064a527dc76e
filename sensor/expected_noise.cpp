#include "sensor/expected_noise.h"

#include <algorithm>

#include "sensor/optics.h"

namespace hilcam {
namespace {

Spectrum most_sensitive(const CameraModel& camera, const SpectralGrid& grid) {
    if (camera.color_filter.pattern.empty()) return electrons_per_s_per_radiance(camera, grid);
    Spectrum most;
    for (const ColorFilterConfig& filter : camera.color_filter.filters) {
        const Spectrum one = electrons_per_s_per_radiance(camera, grid, &filter.transmission);
        for (int b = 0; b < grid.size(); ++b) most[b] = std::max(most[b], one[b]);
    }
    return most;
}

double square(double x) { return x * x; }

}  // namespace

ExpectedNoise::ExpectedNoise(const CameraModel& camera, const SpectralGrid& grid,
                             const SensorSampling& sampling)
    : camera_(camera), oversampling_(sampling.oversampling), electrons_per_s_(most_sensitive(camera, grid)) {}

PixelNoise ExpectedNoise::of(const Exposure& exposure) const {
    const auto [binning_x, binning_y] = binning_of(camera_, exposure);
    const auto binned = static_cast<double>(binning_x * binning_y);
    const double reading_e2 =
        square(camera_.dark_noise_e()) + square(1 / camera_.system_gain_dn_e(exposure.gain_db)) / 12;
    PixelNoise noise;
    noise.electrons_per_radiance = static_cast<float>(exposure.exposure_s) * electrons_per_s_;
    // Per pixel: n binned charges share one reading, so each has an n-th of its variance.
    noise.dark_variance_e2 =
        static_cast<float>(reading_e2 / (camera_.binning == BinningKind::kCharge ? binned : 1.0) +
                           camera_.dark_current_now_e_s() * exposure.exposure_s + square(camera_.dsnu_e));
    noise.gain_fraction = static_cast<float>(camera_.prnu_fraction);
    noise.averaged = static_cast<float>(square(oversampling_));
    return noise;
}

}  // namespace hilcam
