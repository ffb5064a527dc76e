#pragma once
// Jitter of the line of sight moves the picture during an exposure and from one exposure to the next.
//
// Gaussian of a fixed standard deviation within any exposure, or from a one-sided power spectral density S(f)
// per axis, linear between its samples and zero outside them. Of the latter an exposure of T blurs what is
// fast, with the variance
//     integral S(f) (1 - sinc^2(f T)) df,        sinc x = sin(pi x) / (pi x)
// about the mean pointing of the exposure, and shows the rest, integral S(f) sinc^2(f T) df, as a
// displacement of the whole picture from frame to frame (Lucke, Sirlin & San Martin, "New definitions of
// pointing stability: AC and DC effects", J. Astronautical Sciences 40(4), 1992). Not modelled: roll;
// that a single exposure's blur is not Gaussian when few vibrations fall into it; and that the rows of a
// rolling shutter and the lines of a scanner are displaced one by one (they go with the frame's middle).

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/table.h"

namespace hilcam {

struct JitterConfig {
    std::vector<double> rms_rad = {0, 0};  // about the camera's x and y axes, within any exposure
    Table psd_arcsec2_hz;                  // f [Hz], S [arcsec^2/Hz] of each axis; empty: none
};
Fields fields(JitterConfig& config);
// A density needs a band: two samples. InputError.
void validate(const JitterConfig& config);

// Variance about each axis, within an exposure, of what the density says [rad^2]; rms_rad is not in it.
// In closed form for each piece of the table, to 1e-12 of the density's total. Any thread.
double jitter_blur_rad2(const JitterConfig& config, double exposure_s);

// The mean pointing of exposures: a sum of sinusoids whose frequencies, Rayleigh amplitudes and phases are
// drawn once from the seed. The band is cut into parts of equal variance with one sinusoid each, at a random
// frequency of its part; so over seeds the variance at any instant is the integral above, exactly, and the
// displacement is Gaussian.
class PointingJitter {
  public:
    static constexpr int kSinusoids = 128;  // per axis

    // No displacement.
    PointingJitter() = default;
    // Times are counted from `start`. Owner thread.
    PointingJitter(const JitterConfig& config, std::uint64_t seed, TimeTai start);

    // Rotation about the camera's x and y axes [rad], the mean over an exposure centred at `middle`.
    // A pure function. Loop, any thread.
    Vec2d at(TimeTai middle, double exposure_s) const;
    // The pose with that rotation.
    Pose applied(const Pose& camera, TimeTai middle, double exposure_s) const;

  private:
    struct Sinusoid {
        double frequency_hz = 0, amplitude_rad = 0, phase_rad = 0;
    };
    TimeTai start_;
    std::array<std::vector<Sinusoid>, 2> axes_;
};

}  // namespace hilcam
