#include "sensor/optics_otf.h"

#include <cmath>
#include <functional>

#include "render/sky/sun.h"
#include "sensor/mtf.h"
#include "sensor/zernike.h"

namespace hilcam {

struct OpticsOtf::Bin {
    double weight;
    double shift_per_cy_px;
    double wavefront_rms_waves;
    PupilTransfer transfer;
};

OpticsOtf::~OpticsOtf() = default;
OpticsOtf::OpticsOtf(OpticsOtf&&) noexcept = default;
OpticsOtf& OpticsOtf::operator=(OpticsOtf&&) noexcept = default;

OpticsOtf::OpticsOtf(const CameraModel& c, const SpectralGrid& grid, const Spectrum& response,
                     const LensState& lens) {
    if (!c.measured_mtf.mtf.empty()) {
        const Table& mtf = c.measured_mtf.mtf;
        const double cycles_mm_per_cy_px = 1e-3 / c.pitch_m;
        last_cy_px_ = mtf.x.back() / cycles_mm_per_cy_px;
        tabulate([&](double f) { return mtf.at(f * cycles_mm_per_cy_px); });
        return;
    }
    const Spectrum sun = solar_irradiance_1au_w_m2_um(grid);
    double total = 0;
    for (int b = 0; b < grid.size(); ++b)
        total += static_cast<double>(response[b]) * static_cast<double>(sun[b]);
    struct Part {
        double weight, shift_per_cy_px, wavelength_m, w20_waves;
    };
    std::vector<Part> parts;
    for (int b = 0; b < grid.size(); ++b) {
        // A camera that is blind in the whole grid still has a lens: all bins then have equal weights.
        const double weight = total > 0
                                  ? static_cast<double>(response[b]) * static_cast<double>(sun[b]) / total
                                  : 1.0 / grid.size();
        if (!(weight > 0)) continue;
        const double wavelength_m = grid.center_um(b) * 1e-6;
        parts.push_back({weight, 2 * wavelength_m * c.f_number / c.pitch_m, wavelength_m,
                         lens.defocus_m / (8 * c.f_number * c.f_number) / wavelength_m});
        last_cy_px_ = std::max(last_cy_px_, 2 / parts.back().shift_per_cy_px);
    }
    if (c.zernike_m.empty()) {
        tabulate([&](double f) {
            double sum = 0;
            for (const Part& p : parts) {
                const double shift = f * p.shift_per_cy_px;
                sum += p.weight * pupil_otf(shift, c.central_obscuration_ratio, p.w20_waves) *
                       aberration_mtf(shift, lens.wavefront_rms_m / p.wavelength_m);
            }
            return sum;
        });
        return;
    }
    for (const Part& p : parts) {
        std::vector<double> waves = c.zernike_m;
        for (double& w : waves) w /= p.wavelength_m;
        bins_.push_back({p.weight, p.shift_per_cy_px, lens.wavefront_rms_m / p.wavelength_m,
                         PupilTransfer(c.central_obscuration_ratio, p.w20_waves, waves)});
    }
}

void OpticsOtf::tabulate(const std::function<double(double)>& radial) {
    constexpr int kSteps = 512;
    table_.assign(kSteps + 2, 0.0);
    for (std::size_t i = 0; i <= kSteps; ++i)
        table_[i] = radial(last_cy_px_ * static_cast<double>(i) / kSteps);
}

std::complex<double> OpticsOtf::at(double u, double v) const {
    if (!bins_.empty()) {
        std::complex<double> sum = 0;
        for (const Bin& b : bins_)
            sum += b.weight * aberration_mtf(std::hypot(u, v) * b.shift_per_cy_px, b.wavefront_rms_waves) *
                   b.transfer.at(u * b.shift_per_cy_px, v * b.shift_per_cy_px);
        return sum;
    }
    const double steps = static_cast<double>(table_.size() - 2);
    const double x = std::hypot(u, v) / last_cy_px_ * steps;
    if (!(x < steps)) return 0;
    const auto i = static_cast<std::size_t>(x);
    const double part = x - static_cast<double>(i);
    return table_[i] + part * (table_[i + 1] - table_[i]);
}

}  // namespace hilcam
