#include "sensor/stray/spider.h"

#include <algorithm>
#include <cmath>

#include "render/sky/sun.h"
#include "render/vocabulary/units.h"

namespace hilcam {

Fields fields(SpiderConfig& s) {
    return {
        integer("vanes", s.vanes, {0, 12}, "number of vanes, evenly spaced; 0: no spider"),
        number("width_mm", s.width_m, 1e-3, {0, 1000}, "width of a vane seen along the optical axis"),
        number("angle_deg", s.angle_rad, kDegree_rad, {-360, 360},
               "direction of the first vane, from the picture's right edge towards its lower edge; its spike "
               "is perpendicular to it"),
    };
}

namespace {

double vane_length_m(const SpiderPupil& p) { return 0.5 * p.diameter_m * (1 - p.obscuration_ratio); }

double sinc_squared(double x) {
    const double a = kPi * x, s = std::abs(a) < 1e-6 ? 1 : std::sin(a) / a;
    return s * s;
}

}  // namespace

double SpiderPupil::open_area_m2() const {
    return kPi / 4 * diameter_m * diameter_m * (1 - obscuration_ratio * obscuration_ratio);
}

double vane_area_m2(const SpiderConfig& c, const SpiderPupil& pupil) {
    return static_cast<double>(c.vanes) * c.width_m * vane_length_m(pupil);
}

void check_spider(const SpiderConfig& c, const SpiderPupil& pupil) {
    if (c.vanes > 0 && !(c.width_m > 0))
        throw InputError("spider.width_mm: found 0 with " + std::to_string(c.vanes) +
                         " vanes; accepted: a width above 0");
    if (vane_area_m2(c, pupil) > 0.5 * pupil.open_area_m2())
        throw InputError("spider: its vanes cover more than half of the aperture; accepted: less");
}

SpiderSpikes::SpiderSpikes(const SpiderConfig& c, const SpiderPupil& pupil, const SpectralGrid& grid,
                           const Spectrum& response) {
    if (c.vanes == 0) return;
    const double vanes_m2 = vane_area_m2(c, pupil);
    share_ = vanes_m2 / (pupil.open_area_m2() - vanes_m2);
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    double total = 0;
    for (int b = 0; b < grid.size(); ++b) total += static_cast<double>(response[b] * sun[b]);
    // Narrow bins, so that the minima of the spikes average out as they do in a broad band.
    constexpr int kParts = 8;
    double length_px = 0;
    for (int b = 0; b < grid.size(); ++b) {
        const double weight =
            total > 0 ? static_cast<double>(response[b] * sun[b]) / total : 1.0 / grid.size();
        if (!(weight > 0)) continue;
        for (int k = 0; k < kParts; ++k) {
            const double wavelength_m = (grid.from_um(b) + (k + 0.5) / kParts * grid.width_um(b)) * 1e-6;
            const double scale = pupil.pitch_m / (wavelength_m * pupil.focal_length_m);
            bins_.push_back({weight / kParts, c.width_m * scale, vane_length_m(pupil) * scale});
            length_px += weight / kParts / bins_.back().length_cy_px;
        }
    }
    for (std::int64_t k = 0; k < c.vanes; ++k) {
        const double angle = c.angle_rad + 2 * kPi * static_cast<double>(k) / static_cast<double>(c.vanes);
        vanes_.push_back({-std::sin(angle), std::cos(angle)});
    }
    // sinc^2(y / a) is at half its height at 0.443 a, a Gaussian at 1.177 sigma.
    const double across_px = 0.443 / 1.177 * length_px;
    const double diffusion_px = pupil.diffusion_m / pupil.pitch_m;
    across_sigma_px_ = std::sqrt(across_px * across_px + diffusion_px * diffusion_px);
    const auto reach = static_cast<std::size_t>(std::ceil(1.5 * pupil.reach_px) + 2);
    constexpr int kSteps = 8;
    for (std::size_t i = 0; i < reach; ++i) {
        double sum = 0;
        for (int k = 0; k < kSteps; ++k) {
            const double x = static_cast<double>(i) + (k + 0.5) / kSteps - 0.5;
            for (const Bin& bin : bins_) {
                sum += bin.weight * bin.width_cy_px * sinc_squared(x * bin.width_cy_px);
            }
        }
        along_.push_back(static_cast<float>(sum / kSteps));
    }
    peak_ =
        share_ * static_cast<double>(along_.front()) / std::max(1.0, across_sigma_px_ * std::sqrt(2 * kPi));
}

double SpiderSpikes::transfer(double u, double v) const {
    double sum = 0;
    for (const Vane& vane : vanes_) {
        const double across = std::abs(u * vane.cosine + v * vane.sine),
                     along = std::abs(v * vane.cosine - u * vane.sine);
        for (const Bin& bin : bins_)
            sum += bin.weight * std::max(0.0, 1 - across / bin.width_cy_px) *
                   std::max(0.0, 1 - along / bin.length_cy_px);
    }
    return sum / static_cast<double>(vanes_.size());
}

double SpiderSpikes::along(double distance_px) const {
    const auto i = static_cast<std::size_t>(distance_px);
    if (i + 1 >= along_.size()) return 0;
    const double part = distance_px - static_cast<double>(i);
    return static_cast<double>(along_[i]) * (1 - part) + static_cast<double>(along_[i + 1]) * part;
}

}  // namespace hilcam
