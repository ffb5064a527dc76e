#include "sensor/optics.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

double aperture_area_m2(const CameraModel& c) {
    const double d = c.aperture_diameter_m();
    const double open_m2 = kPi / 4 * d * d * (1 - c.central_obscuration_ratio * c.central_obscuration_ratio);
    return c.spider.vanes > 0 ? open_m2 - vane_area_m2(c.spider, spider_pupil(c)) : open_m2;
}

SpiderPupil spider_pupil(const CameraModel& c) {
    return {c.aperture_diameter_m(),
            c.central_obscuration_ratio,
            c.focal_length_m,
            c.pitch_m,
            c.diffusion_m,
            std::hypot(static_cast<double>(c.width_px), static_cast<double>(c.height_px))};
}

OutsideLens outside_lens(const CameraModel& c) {
    const double best = c.has_t_number
                            ? lens_transmission(c, 0.55)
                            : *std::max_element(c.transmission.value.begin(), c.transmission.value.end());
    return {c.f_number, c.central_obscuration_ratio, c.pitch_m, c.fill_factor, aperture_area_m2(c), best};
}

double lens_transmission(const CameraModel& c, double wavelength_um) {
    if (!c.has_t_number) return c.transmission.at(wavelength_um);
    return c.f_number * c.f_number / (c.t_number * c.t_number);
}

Spectrum electrons_per_s_per_irradiance(const CameraModel& c, const SpectralGrid& grid, const Curve* filter) {
    const double area_m2 = aperture_area_m2(c);
    Spectrum out;
    for (int b = 0; b < grid.size(); ++b) {
        // Integral of T QE lambda over the bin, by Simpson's rule on 32 pieces; curves are linear between
        // their knots.
        constexpr int kPieces = 32;
        const double step = grid.width_um(b) / kPieces;
        double electrons_per_joule_um = 0;
        for (int i = 0; i <= kPieces; ++i) {
            const double wavelength_um = grid.from_um(b) + i * step;
            const double factor = i == 0 || i == kPieces ? 1 : (i % 2 ? 4 : 2);
            electrons_per_joule_um += factor * step / 3 * lens_transmission(c, wavelength_um) *
                                      (filter ? filter->at(wavelength_um) : 1.0) *
                                      c.quantum_efficiency.at(wavelength_um) / photon_energy_j(wavelength_um);
        }
        out[b] = static_cast<float>(area_m2 * electrons_per_joule_um);
    }
    return out;
}

Spectrum electrons_per_s_per_radiance(const CameraModel& c, const SpectralGrid& grid, const Curve* filter) {
    const double pixel_rad = c.pitch_m / c.focal_length_m;
    Spectrum out = electrons_per_s_per_irradiance(c, grid, filter);
    for (float& value : out.bin) value *= static_cast<float>(pixel_rad * pixel_rad * c.fill_factor);
    return out;
}

std::vector<Spectrum> channel_responses(const CameraModel& c, const SpectralGrid& grid) {
    if (c.color_filter.pattern.empty()) return {electrons_per_s_per_radiance(c, grid)};
    std::vector<Spectrum> out;
    for (const ColorFilterConfig& filter : c.color_filter.filters)
        out.push_back(electrons_per_s_per_radiance(c, grid, &filter.transmission));
    return out;
}

RelativeIllumination::RelativeIllumination(const CameraModel& camera, const ImageGeometry& geometry)
    : geometry_(geometry),
      one_line_(camera.shutter.kind == ShutterKind::kLineScan),
      cos_power_(camera.cos_power),
      vignetting_(camera.vignetting) {
    // Uses the corners of the whole sensor, whatever the window.
    CameraModel whole = camera;
    whole.window_px.clear();
    const double focal_length_px = camera.focal_length_m / camera.pitch_m;
    const ImageGeometry sensor = geometry_of(whole, 0);
    const Vec2d center = sensor.center_px();
    double farthest_px = 0;
    for (const double x : {0.0, 1.0 * sensor.width_px})
        for (const double y : {0.0, 1.0 * sensor.height_px})
            farthest_px = std::max(farthest_px, std::hypot(x - center.x, one_line_ ? 0.0 : y - center.y));
    corner_px_ = farthest_px * geometry.focal_length_px / focal_length_px;
    axis_solid_angle_ = 1 / (geometry.focal_length_px * geometry.focal_length_px);
}

double RelativeIllumination::field_fraction(double x_px, double y_px) const {
    const Vec2d center = geometry_.center_px();
    return std::hypot(x_px - center.x, on_sensor(y_px) - center.y) / corner_px_;
}

double RelativeIllumination::at(double x_px, double y_px) const {
    const double cosine = 1 / length(geometry_.direction_camera(x_px, on_sensor(y_px)));
    const double lens = vignetting_.empty() ? 1 : vignetting_.at(field_fraction(x_px, y_px));
    return std::pow(cosine, cos_power_) * lens;
}

double RelativeIllumination::of_point(double x_px, double y_px) const {
    // Without distortion, a pixel's solid angle falls with the third power of the cosine.
    if (geometry_.distortion.none() && cos_power_ == 4) {
        const double lens = vignetting_.empty() ? 1 : vignetting_.at(field_fraction(x_px, y_px));
        return lens / length(geometry_.direction_camera(x_px, on_sensor(y_px)));
    }
    return at(x_px, y_px) * axis_solid_angle_ / solid_angle(x_px, on_sensor(y_px));
}

// A pixel covers an area a of the plane z = 1, along its normal; from the lens its solid angle is a cos /
// d^2.
double RelativeIllumination::solid_angle(double x_px, double y_px) const {
    constexpr double kHalf_px = 0.5;
    const Vec3d d = geometry_.direction_camera(x_px, y_px);
    const Vec3d across =
        geometry_.direction_camera(x_px + kHalf_px, y_px) - geometry_.direction_camera(x_px - kHalf_px, y_px);
    const Vec3d down =
        geometry_.direction_camera(x_px, y_px + kHalf_px) - geometry_.direction_camera(x_px, y_px - kHalf_px);
    const double distance = length(d);
    return std::abs(dot(cross(across, down), d)) / (distance * distance * distance);
}

}  // namespace hilcam
