#pragma once
// Measures a camera from its own frames by EMVA Standard 1288, Release 4.0 Linear (European Machine Vision
// Association, 2021). Frames come as statistics (frame_statistics.h), and the laboratory provides the light
// on the detector. Section numbers are those of that release.
//
// Two things go beyond the standard, with reasons where they are done: a small-signal gain for detectors that
// are not quite linear, and shading that is removed from the non-uniformity because the lens stays on.

#include <span>
#include <vector>

#include "sensor/measure/frame_statistics.h"
#include "sensor/measure/least_squares.h"

namespace hilcam {

// One step of the photon-transfer series: frame pairs with light, and pairs without light at the same
// exposure time.
struct LightPoint {
    double photons = 0;  // mu_p: for each pixel and exposure, mean over the selection
    TemporalStatistics light, dark;

    double signal_dn() const { return light.mean_dn.value - dark.mean_dn.value; }
    double shot_dn2() const { return light.variance_dn2.value - dark.variance_dn2.value; }
    double signal_variance() const;  // variance of signal_dn()'s error
    double shot_variance() const;    // variance of shot_dn2()'s error
};

// Section 6.6: returns the saturation point, the last one before the temporal variance falls.
std::size_t saturation_index(std::span<const LightPoint> points);

// Section 6.4: straight lines through the origin, without weights, over signals up to 70 % of saturation.
struct PhotonTransfer {
    Measured gain_dn_e;               // K: slope of sigma_y^2 - sigma_y.dark^2 over mu_y - mu_y.dark
    Measured responsivity_dn_photon;  // R: slope of mu_y - mu_y.dark over mu_p
};
PhotonTransfer photon_transfer(std::span<const LightPoint> points, double saturation_dn);

// Signal as a function of photons: a polynomial of third degree with an offset (for light outside the
// exposure, as with a frame-transfer CCD), fitted over signals up to 95 % of saturation with equal relative
// errors.
class ResponseCurve {
  public:
    ResponseCurve(std::span<const LightPoint> points, double saturation_dn);
    double signal_dn(double photons) const;
    double slope_dn_photon(double photons) const;
    // Returns the light for a signal, by Newton's method, for signals up to slightly beyond saturation.
    double photons(double signal_dn) const;
    // Returns the responsivity for small signals: the slope without light.
    Measured responsivity_dn_photon() const;
    double offset_dn() const { return fit_.coefficient[0]; }
    // Returns the coefficients of (photons / scale)^k, with their covariance.
    const Fitted& fit() const { return fit_; }

  private:
    Fitted fit_;
    double scale_ = 1;
};

// The charge behind a signal: (R0 x photons + offset) / K, with R0 the slope without light; small signals are
// straight in it.
Measured charge_e(const ResponseCurve& response, const Measured& gain_dn_e, double signal_dn);

// The bend of the response as a camera file has it: a charge q is read as q (1 + a2 x + a3 x^2), x = q / full
// well.
struct Bend {
    Measured a2, a3;
};
Bend bend(const ResponseCurve& response, const Measured& gain_dn_e, double full_well_e);

// Returns K for small signals. The standard's K is one slope for all signals; where the response bends by a
// share a at full scale, that slope is off by 1.6 a. Mean and variance are therefore first transformed to the
// straight line of small signals: mu by the inverse of the curve, sigma^2 by the square of its slope.
Measured small_signal_gain_dn_e(std::span<const LightPoint> points, const ResponseCurve& response,
                                double saturation_dn);

// Section 6.5: returns sqrt(sigma_y.dark^2 - 1/12 DN^2) / K. If the noise does not span the converter's
// steps, the standard only gives a bound. Frames with a longer exposure, where the shot noise of the dark
// current helps, then give a better value: `dark_signal_dn` is the mean signal of that current, and K times
// it is subtracted. bandwidth: see NoiseSums.
Measured dark_noise_e(const TemporalStatistics& dark, double dark_signal_dn, const Measured& gain_dn_e,
                      double bandwidth = 1);

// Section 7: slopes of mean and variance of dark frames over exposure time.
struct DarkPoint {
    double exposure_s = 0;
    TemporalStatistics dark;
};
struct DarkCurrent {
    Measured from_mean_e_s, from_variance_e_s;
    double offset_dn = 0;  // mean at zero exposure
    double offset_uncertainty_dn = 0;
};
DarkCurrent dark_current_e_s(std::span<const DarkPoint> points, const Measured& gain_dn_e,
                             double bandwidth = 1);

// Section 6.7: a line fitted to signals from 5 to 95 % of saturation with weights 1/signal^2, the relative
// deviations of the points from it, and LE, the mean of their magnitudes.
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

// Section 8: standard deviations that stay from frame to frame, split into rows, columns and pixels.
struct Nonuniformity {
    Measured total, row, column, pixel;
    std::vector<double> image;  // each pixel's deviation, over the selection's rectangle
};
// Returns DSNU1288 [e-] from L dark frames, after subtracting a slope of the dark picture. A filter along the
// rows smooths fixed differences between pixels as it does noise; `bandwidth` corrects for that.
Nonuniformity dsnu_e(const FrameStack& dark, const TemporalStatistics& temporal,
                     const PixelSelection& selection, const Measured& gain_dn_e, double bandwidth = 1);
// The same from any mean picture in the dark, such as a fit at zero exposure. rest: variance of its random
// error.
struct PictureError {
    double pixel_dn2 = 0, row_dn2 = 0;
};
Nonuniformity dsnu_e(std::span<const double> dark_dn, const PictureError& rest,
                     const PixelSelection& selection, const Measured& gain_dn_e, double bandwidth = 1);
// Returns PRNU1288, a fraction, from L flat and L dark frames with the same exposure. The standard subtracts
// variances, s^2_50 - s^2_dark. Here it is the variance of the difference between the two averaged images: it
// has the same expectation if gains and offsets are independent, and is right if they are not. The lens's
// shading is divided out as a smooth surface, because a laboratory illuminates the bare detector evenly, but
// here the lens stays on.
Nonuniformity prnu_fraction(const FrameStack& flat, const TemporalStatistics& flat_temporal,
                            const FrameStack& dark, const TemporalStatistics& dark_temporal,
                            const PixelSelection& selection, double bandwidth = 1);

// The same from the difference of two mean pictures with that mean.
Nonuniformity prnu_fraction(std::vector<double> flat_less_dark_dn, double signal_dn, const PictureError& rest,
                            const PixelSelection& selection, double bandwidth = 1);

// These figures follow from the others (section 6.6 and annex): mu_e.min = sqrt(sigma_d^2 + 1/(12 K^2)) +
// 1/2; the dynamic range, saturation over mu_e.min; and SNR_max = sqrt(mu_e.sat). Both ratios are in dB, 20
// log10.
Measured absolute_threshold_e(const Measured& dark_noise_e, const Measured& gain_dn_e);
Measured dynamic_range_db(const Measured& saturation_e, const Measured& threshold_e);
Measured snr_max_db(const Measured& saturation_e);

}  // namespace hilcam
