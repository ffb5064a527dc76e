#include "sensor/ideal_sensor.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

ConverterConfig without_errors(ConverterConfig config) {
    config.inl_lsb = config.dnl_lsb = 0;
    return config;
}

}  // namespace

IdealSensor::IdealSensor(const CameraModel& camera, const SensorSampling& sampling)
    : camera_(camera),
      oversampling_(sampling.oversampling),
      guard_px_(sampling.guard_px * sampling.oversampling),
      window_width_px_(window_of(camera).width * sampling.oversampling),
      window_height_px_(window_of(camera).height * sampling.oversampling),
      mosaic_(camera),
      converter_(without_errors(camera.converter), static_cast<int>(camera.bits), 0, camera.number_bits()) {}

double IdealSensor::rate_in(const RadianceImage& light, const PixelReach& x, const PixelReach& y) const {
    double sum = 0;
    for (int j = std::max(y.first, 0); j < std::min(y.last, window_height_px_); ++j)
        for (int i = std::max(x.first, 0); i < std::min(x.last, window_width_px_); ++i) {
            const int channel = mosaic_.channel(i / oversampling_, j / oversampling_);
            sum += static_cast<double>(
                light.row(j + guard_px_, channel)[static_cast<std::size_t>(i + guard_px_)]);
        }
    return sum;
}

DnImage IdealSensor::take(const RadianceImage& light, Exposure exposure, const FrameLayout& layout) const {
    HILCAM_CHECK(light.width() == window_width_px_ + 2 * guard_px_ &&
                 light.height() == window_height_px_ + 2 * guard_px_ && !light.responses().empty());
    exposure.binning_x = layout.binning_x, exposure.binning_y = layout.binning_y;
    const FrameRaster raster = raster_of(camera_, oversampling_, layout);
    const DnScale scale = dn_scale_of(camera_, exposure);
    // The image pixels of one detector pixel share its light.
    double dn_per_rate =
        camera_.system_gain_dn_e(exposure.gain_db) * exposure.exposure_s / (oversampling_ * oversampling_);
    if (camera_.binning == BinningKind::kMean)
        dn_per_rate /= static_cast<double>(layout.binning_x * layout.binning_y);
    DnImage frame(raster.width_px, raster.height_px);
    for (int y = 0; y < frame.height(); ++y) {
        const std::span<std::uint16_t> row = frame.row(y);
        const PixelReach rows = reach_of(raster.y, y);
        for (int x = 0; x < frame.width(); ++x) {
            const double dn = scale.black_dn + dn_per_rate * rate_in(light, reach_of(raster.x, x), rows);
            row[static_cast<std::size_t>(x)] =
                static_cast<std::uint16_t>(std::lround(std::clamp(dn, 0.0, scale.full_dn)));
        }
        converter_.compand(row);
    }
    return frame;
}

}  // namespace hilcam
