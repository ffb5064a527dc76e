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

VarianceImage noise_variance(const CameraModel& camera, const ElectronImage& mean_e,
                             const Exposure& exposure) {
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
                    : static_cast<float>(gain_dn_e * gain_dn_e * noise.variance_e2(sum_e, 0));
        }
    return out;
}

}  // namespace hilcam
