#pragma once
// Jitter of the line of sight: it blurs the picture during an exposure and displaces it between exposures.
//
// Jitter is given as a Gaussian with a fixed standard deviation within any exposure, or as a one-sided power
// spectral density S(f) for each axis, linear between its samples and zero outside them. An exposure of
// length T is blurred by the fast part, with the variance
//     integral S(f) (1 - sinc^2(f T)) df,        sinc x = sin(pi x) / (pi x)
// about its mean pointing. The rest, integral S(f) sinc^2(f T) df, displaces the whole picture from frame to
// frame (Lucke, Sirlin & San Martin, "New definitions of pointing stability: AC and DC effects", J.
// Astronautical Sciences 40(4), 1992).
//
// Not modelled: roll; the non-Gaussian blur of an exposure that covers only few vibrations; separate
// displacements for the rows of a rolling shutter or the lines of a scanner, which all move with the frame's
// middle.

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/table.h"

namespace hilcam {

struct JitterConfig {
    std::vector<double> rms_rad = {0, 0};  // about the camera's x and y axes, within any exposure
    Table psd_arcsec2_hz;                  // f [Hz], S [arcsec^2/Hz] for each axis; empty: none
};
Fields fields(JitterConfig& config);
// Throws InputError for a density with fewer than two samples, which has no band.
void validate(const JitterConfig& config);

// Returns the variance about each axis that the density causes within an exposure [rad^2], without rms_rad.
// In closed form for each piece of the table, to 1e-12 of the density's total. Any thread.
double jitter_blur_rad2(const JitterConfig& config, double exposure_s);

// The mean pointing of exposures: a sum of sinusoids with frequencies, Rayleigh amplitudes and phases that
// are drawn once from the seed. The band is cut into parts of equal variance, each with one sinusoid at a
// random frequency within it. Over seeds, the variance at any instant is then exactly the integral above, and
// the displacement is Gaussian.
class PointingJitter {
  public:
    static constexpr int kSinusoids = 128;  // per axis

    // Makes pointing without displacement.
    PointingJitter() = default;
    // Times are counted from `start`. Owner thread.
    PointingJitter(const JitterConfig& config, std::uint64_t seed, TimeTai start);

    // Returns the rotation about the camera's x and y axes [rad], as the mean over an exposure centred at
    // `middle`. A pure function. Loop, any thread.
    Vec2d at(TimeTai middle, double exposure_s) const;
    // Returns the pose with that rotation.
    Pose applied(const Pose& camera, TimeTai middle, double exposure_s) const;

  private:
    struct Sinusoid {
        double frequency_hz = 0, amplitude_rad = 0, phase_rad = 0;
    };
    TimeTai start_;
    std::array<std::vector<Sinusoid>, 2> axes_;
};

}  // namespace hilcam
