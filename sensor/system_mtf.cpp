#include "sensor/system_mtf.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/mtf.h"

namespace hilcam {

SystemMtf::SystemMtf(const CameraModel& c, OpticsOtf optics, SpiderSpikes spikes)
    : optics_(std::move(optics)),
      spikes_(std::move(spikes)),
      aperture_x_px_(c.pixel_aperture_x_m() / c.pitch_m),
      aperture_y_px_(c.pixel_aperture_y_m() / c.pitch_m),
      diffusion_px_(c.diffusion_m / c.pitch_m),
      // A rotation about x moves the picture along y.
      jitter_x_px_(c.jitter.rms_rad[1] * c.focal_length_m / c.pitch_m),
      jitter_y_px_(c.jitter.rms_rad[0] * c.focal_length_m / c.pitch_m),
      crosstalk_(c.color_filter.pattern.empty() ? c.crosstalk_fraction : 0),
      glare_(c.stray_light.veiling_glare_fraction),
      glare_radius_px_(c.stray_light.glare_radius_px) {
    if (c.shutter.kind != ShutterKind::kLineScan) return;
    step_px_ = 1.0 / static_cast<double>(c.shutter.tdi_phases);
    drift_px_ = static_cast<double>(c.shutter.tdi_stages) * c.shutter.tdi_mismatch_fraction;
}

double SystemMtf::behind_lens(double u, double v) const {
    const double detector = sinc(u * aperture_x_px_) * sinc(v * aperture_y_px_) *
                            gaussian_mtf(std::hypot(u, v), diffusion_px_) * crosstalk_mtf(u, v, crosstalk_);
    const double motion = gaussian_mtf(u, jitter_x_px_) * gaussian_mtf(v, jitter_y_px_) * sinc(v * step_px_) *
                          sinc(v * drift_px_);
    const double halo = glare_radius_px_ > 0 ? glare_factor(u, v) : 1;
    return detector * motion * halo;
}

std::complex<double> SystemMtf::of_point(double u, double v) const {
    return optics_.at(u, v) * behind_lens(u, v);
}

std::complex<double> SystemMtf::at(double u, double v) const {
    const double even = glare_radius_px_ > 0 ? 1 : glare_factor(u, v);
    if (spikes_.share() == 0) return of_point(u, v) * even;
    const double spikes = spikes_.share() * spikes_.transfer(u, v);
    return ((1 - spikes_.share()) * optics_.at(u, v) + spikes) * (behind_lens(u, v) * even);
}

double SystemMtf::wing_slope_px() const {
    constexpr double kSmall_cy_px = 1e-3;
    return std::max(0.0, (1 - std::abs(optics_.at(kSmall_cy_px, 0))) / kSmall_cy_px);
}

double SystemMtf::glare_factor(double u, double v) const {
    const double f = std::hypot(u, v);
    if (f == 0) return 1;
    const double spread = glare_radius_px_ > 0 ? std::exp(-2 * kPi * glare_radius_px_ * f) : 0;
    return 1 - glare_ + glare_ * spread;
}

}  // namespace hilcam
