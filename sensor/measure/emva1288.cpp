#include "sensor/measure/emva1288.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/measure/least_squares.h"

namespace hilcam {
namespace {

// The variance of a uniform rounding error of one DN (section 2.4).
constexpr double kQuantisation_dn2 = 1.0 / 12;
// A polynomial of fourth degree removes falloff and vignetting over a window to 1e-5; it also removes fifteen
// degrees of freedom from a random pattern.
constexpr int kShadingOrder = 4;

std::vector<double> sum_of_images(std::vector<double> a, std::span<const double> b, double factor) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
    return a;
}

// Fits a slope through the origin, without weights.
Measured slope(std::span<const double> x, std::span<const double> y, std::span<const double> variance) {
    const std::vector<double> equal(x.size(), 1.0);
    const Fitted fit = fit_polynomial(x, y, equal, variance, 1, true);
    return {fit.coefficient[0], std::sqrt(fit.variance(0))};
}

// Returns the standard deviation of the constant part, from the variance of averaged frames minus the rest of
// their temporal noise.
Measured deviation(double measured, double temporal_rest, double samples) {
    const double net = measured - temporal_rest;
    const double error = std::max(measured, temporal_rest) * std::sqrt(2 / std::max(samples - 1, 1.0));
    // If chance alone could explain the variance, the result is zero, with the error of the variance as its
    // bound.
    if (net <= 0) return {0, std::sqrt(error)};
    return {std::sqrt(net), std::min(error / (2 * std::sqrt(net)), std::sqrt(error))};
}

Nonuniformity split(std::vector<double> image, const PixelSelection& selection, double pixel_rest,
                    double row_rest, double bandwidth) {
    SpatialParts s = spatial_parts(image, selection);
    s.pixel /= bandwidth, s.column /= bandwidth, pixel_rest /= bandwidth;
    s.total = s.pixel + s.column + s.row;
    Nonuniformity out;
    out.total = deviation(s.total, pixel_rest + row_rest, s.pixels);
    out.pixel = deviation(s.pixel, pixel_rest, s.pixels);
    out.row = deviation(s.row, row_rest, s.rows);
    out.column = deviation(s.column, 0, s.columns);
    // Means of rows and columns contain a share of the pixels' scatter, with its random error.
    const double of_row = (s.pixel / (s.pixels / s.rows)) * std::sqrt(2 / s.rows);
    const double of_column = (s.pixel / (s.pixels / s.columns)) * std::sqrt(2 / s.columns);
    const auto widen = [](Measured& f, double chance) {
        f.uncertainty = f.value > 0 ? std::min(std::hypot(f.uncertainty, chance / (2 * f.value)),
                                               std::hypot(f.uncertainty, std::sqrt(chance)))
                                    : std::hypot(f.uncertainty, std::sqrt(std::max(chance, 0.0)));
    };
    widen(out.row, of_row), widen(out.column, of_column);
    out.image = std::move(image);
    return out;
}

void scale(Nonuniformity& n, double factor) {
    for (Measured* f : {&n.total, &n.row, &n.column, &n.pixel}) f->value *= factor, f->uncertainty *= factor;
    for (double& value : n.image) value *= factor;
}

}  // namespace

double LightPoint::signal_variance() const {
    return square(light.mean_dn.uncertainty) + square(dark.mean_dn.uncertainty);
}
double LightPoint::shot_variance() const {
    return square(light.variance_dn2.uncertainty) + square(dark.variance_dn2.uncertainty);
}

std::size_t saturation_index(std::span<const LightPoint> points) {
    HILCAM_CHECK(!points.empty());
    const auto most = std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return a.light.variance_dn2.value < b.light.variance_dn2.value;
    });
    return static_cast<std::size_t>(most - points.begin());
}

PhotonTransfer photon_transfer(std::span<const LightPoint> points, double saturation_dn) {
    std::vector<double> photons, signal, shot, signal_variance, shot_variance;
    for (const LightPoint& p : points) {
        if (p.signal_dn() > 0.7 * saturation_dn) continue;
        photons.push_back(p.photons);
        signal.push_back(p.signal_dn()), signal_variance.push_back(p.signal_variance());
        shot.push_back(p.shot_dn2()), shot_variance.push_back(p.shot_variance());
    }
    return {slope(signal, shot, shot_variance), slope(photons, signal, signal_variance)};
}

// --- response

ResponseCurve::ResponseCurve(std::span<const LightPoint> points, double saturation_dn) {
    std::vector<double> x, y, weight, variance;
    for (const LightPoint& p : points)
        if (p.signal_dn() > 0.01 * saturation_dn && p.signal_dn() < 0.95 * saturation_dn)
            scale_ = std::max(x.empty() ? 0.0 : scale_, p.photons), x.push_back(p.photons),
            y.push_back(p.signal_dn()), weight.push_back(1 / square(p.signal_dn())),
            variance.push_back(p.signal_variance());
    for (double& value : x) value /= scale_;
    fit_ = fit_polynomial(x, y, weight, variance, 3);
}

double ResponseCurve::signal_dn(double photons) const {
    const double x = photons / scale_;
    const auto& c = fit_.coefficient;
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}
double ResponseCurve::slope_dn_photon(double photons) const {
    const double x = photons / scale_;
    const auto& c = fit_.coefficient;
    return (c[1] + x * (2 * c[2] + x * 3 * c[3])) / scale_;
}
double ResponseCurve::photons(double signal) const {
    double at = (signal - fit_.coefficient[0]) / fit_.coefficient[1] * scale_;
    for (int step = 0; step < 20; ++step) at -= (signal_dn(at) - signal) / slope_dn_photon(at);
    return at;
}
Measured ResponseCurve::responsivity_dn_photon() const {
    return {fit_.coefficient[1] / scale_, std::sqrt(fit_.variance(1)) / scale_};
}

namespace {

// Returns the standard deviation of a function of a fit's coefficients, from their covariance.
template <class Function>
double propagated(const Fitted& fit, const Function& function) {
    std::vector<double> at = fit.coefficient, slope;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double step = std::sqrt(std::max(fit.variance(i), 0.0));
        const double kept = at[i];
        at[i] = kept + step;
        const double above = function(at);
        at[i] = kept - step;
        slope.push_back(step > 0 ? (above - function(at)) / (2 * step) : 0);
        at[i] = kept;
    }
    double variance = 0;
    for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t j = 0; j < at.size(); ++j)
            variance += slope[i] * slope[j] * fit.covariance[i * at.size() + j];
    return std::sqrt(std::max(variance, 0.0));
}

// Returns the straight signal c0 + c1 u at which the polynomial c has a signal.
double straight_dn(const std::vector<double>& c, double signal_dn) {
    double u = (signal_dn - c[0]) / c[1];
    for (int step = 0; step < 20; ++step)
        u -= (c[0] + u * (c[1] + u * (c[2] + u * c[3])) - signal_dn) / (c[1] + u * (2 * c[2] + u * 3 * c[3]));
    return c[0] + c[1] * u;
}

}  // namespace

Measured charge_e(const ResponseCurve& response, const Measured& gain, double signal_dn) {
    const auto straight = [&](const std::vector<double>& c) { return straight_dn(c, signal_dn); };
    const double value = straight(response.fit().coefficient) / gain.value;
    return {value, std::hypot(propagated(response.fit(), straight) / gain.value,
                              value * gain.uncertainty / gain.value)};
}

Bend bend(const ResponseCurve& response, const Measured& gain, double full_well_e) {
    const double full_dn = gain.value * full_well_e;
    const double of_gain = gain.uncertainty / gain.value;
    const auto a2 = [&](const std::vector<double>& c) { return c[2] / square(c[1]) * full_dn; };
    const auto a3 = [&](const std::vector<double>& c) {
        return c[3] / (c[1] * square(c[1])) * square(full_dn);
    };
    const Fitted& fit = response.fit();
    const double second = a2(fit.coefficient), third = a3(fit.coefficient);
    return {{second, std::hypot(propagated(fit, a2), second * of_gain)},
            {third, std::hypot(propagated(fit, a3), 2 * third * of_gain)}};
}

Measured small_signal_gain_dn_e(std::span<const LightPoint> points, const ResponseCurve& response,
                                double saturation_dn) {
    const Measured small = response.responsivity_dn_photon();
    std::vector<double> signal, shot, variance;
    for (const LightPoint& p : points) {
        if (p.signal_dn() > 0.7 * saturation_dn) continue;
        const double photons = response.photons(p.signal_dn());
        const double straighten = small.value / response.slope_dn_photon(photons);
        // Light from outside the exposure is part of the signal and of its shot noise.
        signal.push_back(small.value * photons + response.offset_dn());
        shot.push_back(p.shot_dn2() * square(straighten));
        variance.push_back(p.shot_variance() * square(square(straighten)));
    }
    Measured gain = slope(signal, shot, variance);
    // The scale of the straight line has the error of the responsivity.
    gain.uncertainty = std::hypot(gain.uncertainty, gain.value * small.uncertainty / small.value);
    return gain;
}

// --- in the dark

Measured dark_noise_e(const TemporalStatistics& dark, double dark_signal_dn, const Measured& gain,
                      double bandwidth) {
    const double shot_dn2 = gain.value * dark_signal_dn;
    const double white = (dark.pixel_dn2() - kQuantisation_dn2) / bandwidth - shot_dn2;
    const double noise_dn = std::sqrt(std::max(white, 0.0) + dark.row_dn2 + dark.frame_dn2);
    // If noise is too small to span a step, the rounding error is not uniform, and only a bound is known.
    if (dark.variance_dn2.value < 0.24 || noise_dn == 0)
        return {noise_dn / gain.value, std::sqrt(0.24) / gain.value};
    // Errors of K enter through the scale, and through the correction for the dark current.
    const double of_variance = dark.variance_dn2.uncertainty / bandwidth / (2 * noise_dn);
    const double of_gain = (noise_dn / gain.value + dark_signal_dn / (2 * noise_dn)) * gain.uncertainty;
    return {noise_dn / gain.value, std::hypot(of_variance, of_gain) / gain.value};
}

DarkCurrent dark_current_e_s(std::span<const DarkPoint> points, const Measured& gain, double bandwidth) {
    std::vector<double> time, mean, mean_variance, mean_weight, variance, variance_variance, variance_weight;
    for (const DarkPoint& p : points) {
        time.push_back(p.exposure_s);
        mean.push_back(p.dark.mean_dn.value);
        mean_variance.push_back(square(p.dark.mean_dn.uncertainty));
        mean_weight.push_back(1 / std::max(mean_variance.back(), 1e-30));
        variance.push_back(p.dark.pixel_dn2() / bandwidth);
        variance_variance.push_back(square(p.dark.variance_dn2.uncertainty / bandwidth));
        variance_weight.push_back(1 / std::max(variance_variance.back(), 1e-30));
    }
    const auto per_gain = [&](double slope, double error, double power) {
        const double factor = 1 / std::pow(gain.value, power);
        return Measured{slope * factor,
                        std::hypot(error * factor, power * slope * factor * gain.uncertainty / gain.value)};
    };
    const Fitted of_mean = fit_polynomial(time, mean, mean_weight, mean_variance, 1);
    const Fitted of_variance = fit_polynomial(time, variance, variance_weight, variance_variance, 1);
    return {per_gain(of_mean.coefficient[1], std::sqrt(of_mean.variance(1)), 1),
            per_gain(of_variance.coefficient[1], std::sqrt(of_variance.variance(1)), 2),
            of_mean.coefficient[0], std::sqrt(of_mean.variance(0))};
}

// --- linearity

std::vector<ResponsePoint> response_points(std::span<const LightPoint> points) {
    std::vector<ResponsePoint> out;
    for (const LightPoint& p : points) out.push_back({p.photons, p.signal_dn(), p.signal_variance()});
    return out;
}

Linearity linearity(std::span<const ResponsePoint> points, double saturation_dn) {
    std::vector<double> photons, signal, weight, variance;
    for (const ResponsePoint& p : points) {
        if (p.signal_dn < 0.05 * saturation_dn || p.signal_dn > 0.95 * saturation_dn) continue;
        photons.push_back(p.photons), signal.push_back(p.signal_dn);
        weight.push_back(1 / square(p.signal_dn)), variance.push_back(p.signal_variance);
    }
    const Fitted fit = fit_polynomial(photons, signal, weight, variance, 1);
    Linearity out;
    double sum = 0, error = 0;
    for (std::size_t i = 0; i < photons.size(); ++i) {
        const double line = fit.coefficient[0] + fit.coefficient[1] * photons[i];
        const double deviation = signal[i] / line - 1;
        out.points.push_back({photons[i], signal[i], line, deviation});
        out.min_fraction = std::min(out.min_fraction, deviation);
        out.max_fraction = std::max(out.max_fraction, deviation);
        sum += std::abs(deviation);
        error += variance[i] / square(line);
    }
    const auto n = static_cast<double>(photons.size());
    // Magnitudes of random deviations do not average out, so the error is their rms, without 1 / sqrt(n).
    out.error_fraction = {sum / n, std::sqrt(error / n)};
    return out;
}

// --- fixed patterns

Nonuniformity dsnu_e(const FrameStack& dark, const TemporalStatistics& temporal,
                     const PixelSelection& selection, const Measured& gain, double bandwidth) {
    const double frames = dark.frames();
    return dsnu_e(dark.mean_dn(), {temporal.pixel_dn2() / frames, temporal.row_dn2 / frames}, selection, gain,
                  bandwidth);
}

Nonuniformity dsnu_e(std::span<const double> dark_dn, const PictureError& rest,
                     const PixelSelection& selection, const Measured& gain, double bandwidth) {
    std::vector<double> image = sum_of_images({dark_dn.begin(), dark_dn.end()},
                                              smooth_surface(dark_dn, selection, kShadingOrder), -1);
    Nonuniformity out = split(std::move(image), selection, rest.pixel_dn2, rest.row_dn2, bandwidth);
    scale(out, 1 / gain.value);
    for (Measured* f : {&out.total, &out.row, &out.column, &out.pixel})
        f->uncertainty = std::hypot(f->uncertainty, f->value * gain.uncertainty / gain.value);
    return out;
}

Nonuniformity prnu_fraction(const FrameStack& flat, const TemporalStatistics& flat_temporal,
                            const FrameStack& dark, const TemporalStatistics& dark_temporal,
                            const PixelSelection& selection, double bandwidth) {
    const auto rest = [&](auto part) {
        return part(flat_temporal) / flat.frames() + part(dark_temporal) / dark.frames();
    };
    return prnu_fraction(sum_of_images(flat.mean_dn(), dark.mean_dn(), -1),
                         flat_temporal.mean_dn.value - dark_temporal.mean_dn.value,
                         {rest([](const TemporalStatistics& t) { return t.pixel_dn2(); }),
                          rest([](const TemporalStatistics& t) { return t.row_dn2; })},
                         selection, bandwidth);
}

Nonuniformity prnu_fraction(std::vector<double> image, double signal_dn, const PictureError& rest,
                            const PixelSelection& selection, double bandwidth) {
    const std::vector<double> shading = smooth_surface(image, selection, kShadingOrder);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = image[i] / shading[i] - 1;
    const double signal_dn2 = square(signal_dn);
    return split(std::move(image), selection, rest.pixel_dn2 / signal_dn2, rest.row_dn2 / signal_dn2,
                 bandwidth);
}

// --- derived figures

Measured absolute_threshold_e(const Measured& noise, const Measured& gain) {
    const double dark = std::sqrt(square(noise.value) + kQuantisation_dn2 / square(gain.value));
    return {dark + 0.5, dark > 0 ? noise.value / dark * noise.uncertainty : noise.uncertainty};
}
Measured dynamic_range_db(const Measured& saturation, const Measured& threshold) {
    return {
        20 * std::log10(saturation.value / threshold.value),
        20 / std::log(10.0) *
            std::hypot(saturation.uncertainty / saturation.value, threshold.uncertainty / threshold.value)};
}
Measured snr_max_db(const Measured& saturation) {
    return {10 * std::log10(saturation.value),
            10 / std::log(10.0) * saturation.uncertainty / saturation.value};
}

}  // namespace hilcam
