#include "emulator/clone/clone_darkness.h"

#include <spdlog/fmt/fmt.h>

#include "render/vocabulary/units.h"
#include "sensor/measure/quantiser.h"

namespace hilcam {
namespace {

class Darkness {
  public:
    Darkness(const DarknessWork& work, CloneMeasurement& out) : work_(work), out_(out) {}

    void measure() {
        measure_dark_noise();
        measure_dark_currents();
    }

  private:
    const MeasuredDark& brief_dark() const {
        return *std::find_if(out_.dark.begin(), out_.dark.end(),
                             [&](const MeasuredDark& d) { return d.series == work_.brief; });
    }
    // Returns the darks at a temperature, with their means made straight in charge.
    std::vector<DarkPoint> points_at(double temperature_c) const {
        std::vector<DarkPoint> out;
        const double base_dn = brief_dark().point.dark.mean_dn.value;
        for (const MeasuredDark& d : out_.dark) {
            if (std::abs(d.temperature_c - temperature_c) > kSameTemperature_k) continue;
            out.push_back(d.point);
            double& mean_dn = out.back().dark.mean_dn.value;
            mean_dn = base_dn + out_.gain_dn_e.value * work_.charge_e(mean_dn - base_dn);
        }
        return out;
    }
    static bool has_two_exposures(const std::vector<DarkPoint>& points) {
        return points.size() > 1 && !same_exposure(points.front().exposure_s, points.back().exposure_s);
    }

    void measure_dark_noise() {
        const TemporalStatistics& dark = brief_dark().point.dark;
        const Measured& gain = out_.gain_dn_e;
        const std::vector<DarkPoint> points = points_at(out_.temperature_c);
        double dark_shot_dn2 = 0;
        if (has_two_exposures(points)) {
            const DarkCurrent current = dark_current_e_s(points, gain);
            out_.dark_current_e_s = current.from_mean_e_s;
            out_.offset_dn = {current.offset_dn, current.offset_uncertainty_dn};
            dark_shot_dn2 =
                square(gain.value) * std::max(0.0, current.from_mean_e_s.value) * points.front().exposure_s;
        } else {
            out_.offset_dn = dark.mean_dn;
            out_.remarks.emplace_back(
                "darks of one exposure: no dark current; the offset contains that of this exposure");
        }
        // Rounding acts on the sum of all noise; rows and frames have a share of it each.
        const auto white_dn2 = [&](double variance_dn2) {
            return variance_before_rounding_dn2(work_.brief_mean_dn, out_.good, variance_dn2) - dark.row_dn2 -
                   dark.frame_dn2 - dark_shot_dn2;
        };
        const double error = dark.variance_dn2.uncertainty;
        const double noise_dn2 = white_dn2(dark.variance_dn2.value);
        const double half = 0.5 * (white_dn2(dark.variance_dn2.value + error) -
                                   white_dn2(std::max(0.0, dark.variance_dn2.value - error)));
        out_.read_noise_e = deviation_e(noise_dn2, half);
        const double rows = work_.frames.height, columns = work_.frames.width;
        const auto pixels = static_cast<double>(out_.good.count());
        out_.row_noise_e =
            deviation_e(dark.row_dn2, line_variance_uncertainty_dn2(dark, dark.row_dn2, rows, pixels / rows));
        out_.column_noise_e = deviation_e(
            dark.column_dn2, line_variance_uncertainty_dn2(dark, dark.column_dn2, columns, pixels / columns));
        if (out_.column_noise_e.value > 0)
            out_.remarks.push_back(fmt::format(
                "noise of {:.2g} e- is common to a column from frame to frame: a camera file has no key for "
                "it, and its read noise contains it",
                out_.column_noise_e.value));
        if (dark.frame_dn2 > 0)
            out_.remarks.push_back(fmt::format(
                "the mean changes by {:.2g} DN from dark frame to dark frame: not in the camera file",
                std::sqrt(dark.frame_dn2)));
    }
    // Turns a variance [DN^2] and its error into a standard deviation [e-]; one that chance explains is 0.
    Measured deviation_e(double variance_dn2, double error_dn2) const {
        const Measured& k = out_.gain_dn_e;
        if (variance_dn2 <= 0) return {0, std::sqrt(std::max(error_dn2, 0.0)) / k.value};
        const double value = std::sqrt(variance_dn2) / k.value;
        return {value, std::hypot(error_dn2 / (2 * std::sqrt(variance_dn2)) / k.value,
                                  value * k.uncertainty / k.value)};
    }

    // Fits the logarithm of the dark current over temperature, where it is seen at all.
    void measure_dark_currents() {
        std::vector<double> temperatures;
        for (const MeasuredDark& d : out_.dark)
            if (std::none_of(temperatures.begin(), temperatures.end(),
                             [&](double t) { return std::abs(t - d.temperature_c) <= kSameTemperature_k; }))
                temperatures.push_back(d.temperature_c);
        std::sort(temperatures.begin(), temperatures.end());
        std::vector<double> warm, logarithm, variance, weight;
        for (const double t : temperatures) {
            const std::vector<DarkPoint> points = points_at(t);
            if (!has_two_exposures(points)) {
                out_.remarks.push_back(
                    fmt::format("darks at {:g} C have one exposure: they do not tell a dark current", t));
                continue;
            }
            const Measured current = dark_current_e_s(points, out_.gain_dn_e).from_mean_e_s;
            out_.dark_currents.push_back({t, current});
            // The gain's error is common to all temperatures.
            const Measured own = dark_current_e_s(points, {out_.gain_dn_e.value, 0}).from_mean_e_s;
            if (own.value < 5 * own.uncertainty) continue;
            warm.push_back(t), logarithm.push_back(std::log2(own.value));
            variance.push_back(square(own.uncertainty / own.value / std::log(2.0)));
            weight.push_back(1 / variance.back());
        }
        if (warm.size() < 2) return;
        const Fitted line = fit_polynomial(warm, logarithm, weight, variance, 1);
        const double slope = line.coefficient[1], error = std::sqrt(line.variance(1));
        if (slope < 5 * error) {
            out_.remarks.emplace_back(
                "the dark current does not rise with temperature: no doubling temperature");
            return;
        }
        out_.dark_doubling_k = Measured{1 / slope, error / square(slope)};
    }

    const DarknessWork& work_;
    CloneMeasurement& out_;
};

}  // namespace

void measure_darkness(const DarknessWork& work, CloneMeasurement& out) { Darkness(work, out).measure(); }

}  // namespace hilcam
