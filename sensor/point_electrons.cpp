#include "sensor/point_electrons.h"

namespace hilcam {
namespace {

// Returns the mean over the filters of the pattern.
Spectrum mean_per_irradiance(const CameraModel& camera, const SpectralGrid& grid) {
    const ColorFilterArrayConfig& array = camera.color_filter;
    if (array.pattern.empty()) return electrons_per_s_per_irradiance(camera, grid);
    Spectrum sum;
    int pixels = 0;
    for (const char letter : array.pattern)
        for (const ColorFilterConfig& filter : array.filters)
            if (filter.name[0] == letter) {
                sum += electrons_per_s_per_irradiance(camera, grid, &filter.transmission);
                ++pixels;
            }
    return 1.0f / static_cast<float>(pixels) * sum;
}

}  // namespace

PointElectrons::PointElectrons(const CameraModel& camera, const SpectralGrid& grid)
    : lens_(camera, geometry_of(camera, 0)),
      per_irradiance_(mean_per_irradiance(camera, grid)),
      bins_(grid.size()) {
    const StrayLightConfig& stray = camera.stray_light;
    const double kept = stray.glare_radius_px <= 0 ? 1 - stray.veiling_glare_fraction : 1.0;
    per_irradiance_ =
        static_cast<float>(camera.fill_factor * kept * (1 - stray.ghost_fraction)) * per_irradiance_;
}

double PointElectrons::of(const Spectrum& irradiance, Vec2d detector_px, double exposure_s) const {
    double sum = 0;
    for (int b = 0; b < bins_; ++b)
        sum += static_cast<double>(per_irradiance_[b]) * static_cast<double>(irradiance[b]);
    return sum * exposure_s * lens_.of_point(detector_px.x, detector_px.y);
}

}  // namespace hilcam
