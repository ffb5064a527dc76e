#pragma once
// A camera's figures from its own frames, after EMVA Standard 1288, Release 4.0 Linear (European Machine
// Vision Association, 2021). Frames come as statistics (frame_statistics.h); what light fell on the detector
// is the laboratory's business. Section numbers are that release's.
//
// Beyond the standard, each with its reason where it is done: a small-signal gain for detectors that are not
// quite linear, and shading taken out of non-uniformity because the lens stays on.

#include <span>
#include <vector>

#include "sensor/measure/frame_statistics.h"

namespace hilcam {

// One step of the photon-transfer series: pairs with light, pairs without at the same exposure time.
struct LightPoint {
    double photons = 0;  // mu_p: per pixel and exposure, mean over the selection
    TemporalStatistics light, dark;

    double signal_dn() const { return light.mean_dn.value - dark.mean_dn.value; }
    double shot_dn2() const { return light.variance_dn2.value - dark.variance_dn2.value; }
    double signal_variance() const;  // variance of signal_dn's error
    double shot_variance() const;    // variance of shot_dn2's error
};

// Section 6.6: the last point before the temporal variance falls: saturation.
std::size_t saturation_index(std::span<const LightPoint> points);

// Section 6.4: straight lines through the origin, unweighted, over signals up to 70 % of saturation.
struct PhotonTransfer {
    Measured gain_dn_e;               // K: slope of sigma_y^2 - sigma_y.dark^2 over mu_y - mu_y.dark
    Measured responsivity_dn_photon;  // R: slope of mu_y - mu_y.dark over mu_p
};
PhotonTransfer photon_transfer(std::span<const LightPoint> points, double saturation_dn);

// Signal over photons by a polynomial of third degree with an offset (light that comes outside the exposure,
// as a frame-transfer CCD's), over signals up to 95 % of saturation, relative errors alike.
class ResponseCurve {
  public:
    ResponseCurve(std::span<const LightPoint> points, double saturation_dn);
    double signal_dn(double photons) const;
    double slope_dn_photon(double photons) const;
    // The light of a signal, by Newton's method; for signals up to a little beyond saturation.
    double photons(double signal_dn) const;
    // For small signals: the slope at no light.
    Measured responsivity_dn_photon() const;
    double offset_dn() const { return coefficient_[0]; }

  private:
    std::vector<double> coefficient_;  // coefficient of (photons / scale_)^k
    double scale_ = 1, slope_uncertainty_ = 0;
};

// K of small signals. The standard's K is one slope for all signals; where the response bends by a share a
// at full scale, that slope is off by 1.6 a. Mean and variance are therefore carried to the straight line of
// small signals first: mu by the curve's inverse, sigma^2 by the square of its slope.
Measured small_signal_gain_dn_e(std::span<const LightPoint> points, const ResponseCurve& response,
                                double saturation_dn);

// Section 6.5: sqrt(sigma_y.dark^2 - 1/12 DN^2) / K. Where the noise is too small to cross the converter's
// steps the standard gives a bound only; frames of a longer exposure, whose dark current's shot noise helps
// across, tell more: `dark_signal_dn` is that current's mean signal in them, and K times it is taken off.
// `bandwidth`: see NoiseSums.
Measured dark_noise_e(const TemporalStatistics& dark, double dark_signal_dn, const Measured& gain_dn_e,
                      double bandwidth = 1);

// Section 7: slopes of mean and variance of dark frames over exposure time.
struct DarkPoint {
    double exposure_s = 0;
    TemporalStatistics dark;
};
struct DarkCurrent {
    Measured from_mean_e_s, from_variance_e_s;
    double offset_dn = 0;  // mean at no exposure
};
DarkCurrent dark_current_e_s(std::span<const DarkPoint> points, const Measured& gain_dn_e,
                             double bandwidth = 1);

// Section 6.7: a line fitted to signals from 5 to 95 % of saturation with weights 1/signal^2, the points'
// deviations from it over its values, and LE, the mean of their magnitudes.
struct LinearityPoint {
    double photons = 0, signal_dn = 0, fit_dn = 0, deviation_fraction = 0;
};
struct Linearity {
    Measured error_fraction;
    double min_fraction = 0, max_fraction = 0;
    std::vector<LinearityPoint> points;
};
struct ResponsePoint {
    double photons = 0, signal_dn = 0, signal_variance = 0;
};
Linearity linearity(std::span<const ResponsePoint> points, double saturation_dn);
std::vector<ResponsePoint> response_points(std::span<const LightPoint> points);

// Section 8: standard deviations that stay from frame to frame, split by rows, columns and pixels.
struct Nonuniformity {
    Measured total, row, column, pixel;
    std::vector<double> image;  // each pixel's deviation, of the selection's rectangle
};
// DSNU1288 [e-] of L dark frames, a slope of the dark picture taken out. A filter along the rows smooths
// what differs from pixel to pixel as it does noise: `bandwidth` undoes that.
Nonuniformity dsnu_e(const FrameStack& dark, const TemporalStatistics& temporal,
                     const PixelSelection& selection, const Measured& gain_dn_e, double bandwidth = 1);
// PRNU1288, a fraction, of L flat and L dark frames of the same exposure. The standard subtracts variances,
// s^2_50 - s^2_dark; here it is the variance of the difference of the two averaged images, of the same mean
// where gains and offsets are independent, and right where they are not. What the lens's shading does is
// divided out as a smooth surface: a laboratory lights the bare detector evenly, here the lens stays on.
Nonuniformity prnu_fraction(const FrameStack& flat, const TemporalStatistics& flat_temporal,
                            const FrameStack& dark, const TemporalStatistics& dark_temporal,
                            const PixelSelection& selection, double bandwidth = 1);

// These figures follow from the others (section 6.6 and annex): mu_e.min = sqrt(sigma_d^2 + 1/(12 K^2)) +
// 1/2, the dynamic range saturation over it, SNR_max = sqrt(mu_e.sat), both in dB of 20 log10.
Measured absolute_threshold_e(const Measured& dark_noise_e, const Measured& gain_dn_e);
Measured dynamic_range_db(const Measured& saturation_e, const Measured& threshold_e);
Measured snr_max_db(const Measured& saturation_e);

}  // namespace hilcam
