#include "emulator/campaign/noise_variance.h"

#include <algorithm>
#include <cmath>

#include "sensor/published_frame.h"
#include "sensor/sensor_noise.h"

namespace hilcam {
namespace {

CameraModel without_patterns(const CameraModel& camera) {
    CameraModel out = camera;
    out.prnu_fraction = out.dsnu_e = 0;
    out.fixed_pattern.row_e = out.fixed_pattern.column_e = 0;
    out.fixed_pattern.dark_current_fraction = out.fixed_pattern.column_gain_fraction = 0;
    return out;
}

}  // namespace

void RenderingNoise::add(const ElectronImage& mean_e, const CameraModel& camera, const Exposure& exposure) {
    const auto [binning_x, binning_y] = binning_of(camera, exposure);
    const auto [width, height] = frame_size(camera, binning_x, binning_y);
    const auto across = static_cast<std::size_t>(width), down = static_cast<std::size_t>(height);
    mean_.resize(across * down), squares_.resize(across * down);
    ++count_;
    for (std::size_t y = 0, i = 0; y < down; ++y)
        for (std::size_t x = 0; x < across; ++x, ++i) {
            double sum_e = 0;
            for (std::size_t v = 0; v < static_cast<std::size_t>(binning_y); ++v)
                for (std::size_t u = 0; u < static_cast<std::size_t>(binning_x); ++u)
                    sum_e += static_cast<double>(
                        mean_e.row(static_cast<int>(y * static_cast<std::size_t>(binning_y) +
                                                    v))[x * static_cast<std::size_t>(binning_x) + u]);
            const double step = sum_e - mean_[i];
            mean_[i] += step / count_;
            squares_[i] += step * (sum_e - mean_[i]);
        }
}

std::vector<double> RenderingNoise::variance_e2() const {
    std::vector<double> out;
    if (count_ < 2) return out;
    out.reserve(squares_.size());
    for (const double square : squares_) out.push_back(square / (count_ - 1));
    return out;
}

VarianceImage noise_variance(const CameraModel& camera, const ElectronImage& mean_e, const Exposure& exposure,
                             std::span<const double> rendering_e2) {
    const auto [binning_x, binning_y] = binning_of(camera, exposure);
    if (binning_x * binning_y > 1 && camera.binning != BinningKind::kCharge)
        throw InputError("pictures.variance: the camera bins numbers; accepted: charge, or no binning");
    if (camera.converter.companding != Companding::kNone || !camera.nonlinearity.empty())
        throw InputError(
            "pictures.variance: the camera's numbers are not linear in its charge; accepted: a linear one");
    const SensorNoise noise(without_patterns(camera), exposure.gain_db);
    const double gain_dn_e = camera.system_gain_dn_e(exposure.gain_db);
    const double most_e = (std::exp2(static_cast<double>(camera.bits)) - 1 -
                           exposure.black_level_dn.value_or(camera.offset_dn)) /
                          gain_dn_e;
    const auto [width, height] = frame_size(camera, binning_x, binning_y);
    VarianceImage out(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double sum_e = 0;
            bool is_full = false;
            for (int v = 0; v < static_cast<int>(binning_y); ++v)
                for (int u = 0; u < static_cast<int>(binning_x); ++u) {
                    const auto column = static_cast<std::size_t>(x * static_cast<int>(binning_x) + u);
                    const auto one_e =
                        static_cast<double>(mean_e.row(y * static_cast<int>(binning_y) + v)[column]);
                    sum_e += one_e;
                    is_full = is_full || one_e >= camera.full_well_e;
                }
            out.row(y)[static_cast<std::size_t>(x)] =
                is_full || sum_e >= most_e
                    ? 0
                    : static_cast<float>(
                          gain_dn_e * gain_dn_e *
                          (noise.variance_e2(sum_e, 0) +
                           (rendering_e2.empty()
                                ? 0
                                : rendering_e2[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                               static_cast<std::size_t>(x)])));
        }
    return out;
}

}  // namespace hilcam
