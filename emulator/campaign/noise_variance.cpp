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

// The charge that becomes one number: the sum over binned pixels [e-].
struct BinnedCharge {
    double sum_e = 0, greatest_e = 0;
};
BinnedCharge charge_of(const ElectronImage& mean_e, int x, int y, int binning_x, int binning_y) {
    BinnedCharge out;
    for (int v = 0; v < binning_y; ++v)
        for (int u = 0; u < binning_x; ++u) {
            const auto column = static_cast<std::size_t>(x * binning_x + u);
            const auto one_e = static_cast<double>(mean_e.row(y * binning_y + v)[column]);
            out.sum_e += one_e;
            out.greatest_e = std::max(out.greatest_e, one_e);
        }
    return out;
}

}  // namespace

void RenderingNoise::add(const ElectronImage& mean_e, const CameraModel& camera, const Exposure& exposure) {
    const auto [binning_x, binning_y] = binning_of(camera, exposure);
    const auto [width, height] = frame_size(camera, binning_x, binning_y);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    mean_.resize(pixels), squares_.resize(pixels);
    ++count_;
    for (int y = 0, i = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i) {
            const double sum_e =
                charge_of(mean_e, x, y, static_cast<int>(binning_x), static_cast<int>(binning_y)).sum_e;
            double& mean = mean_[static_cast<std::size_t>(i)];
            const double step = sum_e - mean;
            mean += step / count_;
            squares_[static_cast<std::size_t>(i)] += step * (sum_e - mean);
        }
}

bool RenderingNoise::is_random() const {
    return std::any_of(squares_.begin(), squares_.end(), [](double square) { return square > 0; });
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
    const double max_e = (std::exp2(static_cast<double>(camera.bits)) - 1 -
                          exposure.black_level_dn.value_or(camera.offset_dn)) /
                         gain_dn_e;
    const auto [width, height] = frame_size(camera, binning_x, binning_y);
    VarianceImage out(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const BinnedCharge charge =
                charge_of(mean_e, x, y, static_cast<int>(binning_x), static_cast<int>(binning_y));
            const bool is_full = charge.greatest_e >= camera.full_well_e || charge.sum_e >= max_e;
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const double all_e2 =
                noise.variance_e2(charge.sum_e, 0) + (rendering_e2.empty() ? 0 : rendering_e2[i]);
            out.row(y)[static_cast<std::size_t>(x)] =
                is_full ? 0 : static_cast<float>(gain_dn_e * gain_dn_e * all_e2);
        }
    return out;
}

}  // namespace hilcam
