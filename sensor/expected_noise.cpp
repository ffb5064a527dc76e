#include "sensor/expected_noise.h"

#include <algorithm>

#include "sensor/optics.h"
#include "sensor/sensor_noise.h"

namespace hilcam {
namespace {

Spectrum most_sensitive(const CameraModel& camera, const SpectralGrid& grid) {
    Spectrum most;
    for (const Spectrum& one : channel_responses(camera, grid))
        for (int b = 0; b < grid.size(); ++b) most[b] = std::max(most[b], one[b]);
    return most;
}

}  // namespace

ExpectedNoise::ExpectedNoise(const CameraModel& camera, const SpectralGrid& grid,
                             const SensorSampling& sampling)
    : camera_(camera), oversampling_(sampling.oversampling), electrons_per_s_(most_sensitive(camera, grid)) {}

PixelNoise ExpectedNoise::of(const Exposure& exposure) const {
    const auto [binning_x, binning_y] = binning_of(camera_, exposure);
    const SensorNoise sensor(
        camera_, exposure.gain_db,
        camera_.binning == BinningKind::kCharge ? static_cast<int>(binning_x * binning_y) : 1);
    const double dark_e = camera_.dark_current_now_e_s() * exposure.exposure_s;
    PixelNoise noise;
    noise.electrons_per_radiance = static_cast<float>(exposure.exposure_s) * electrons_per_s_;
    noise.dark_variance_e2 = static_cast<float>(sensor.variance_e2(dark_e, dark_e));
    noise.gain_fraction = static_cast<float>(sensor.light_share());
    noise.averaged = static_cast<float>(oversampling_ * oversampling_);
    return noise;
}

}  // namespace hilcam
