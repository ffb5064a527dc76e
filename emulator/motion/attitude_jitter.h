#pragma once
// Unsteadiness of a body's attitude: small turns about its axes, a pure function of time, seed and thing.
//
// Each axis has kSinusoids sinusoids whose frequencies lie one in each equal part of the band, at random in
// it, with Rayleigh amplitudes and random phases: over seeds the angle at any instant is Gaussian with the
// given deviation, and the spectrum is flat over the band. Not modelled: correlation between axes. The
// camera's own line of sight may jitter on top (sensor/motion.h).

#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

struct AttitudeState;

struct JitterBand {
    Vec3d rms_rad;  // about the body's axes
    double min_hz = 0.1, max_hz = 10;
};
Fields fields(JitterBand& jitter);
void validate(const JitterBand& jitter);

class AttitudeJitter {
  public:
    static constexpr std::uint32_t kSinusoids = 64;  // per axis

    // None.
    AttitudeJitter() = default;
    // Times are counted from `start`. Owner thread.
    AttitudeJitter(const JitterBand& band, std::uint64_t seed, std::uint32_t thing, TimeTai start);

    // The attitude and its body rate with the turn. To first order in the angles: what is left out is their
    // product. Loop.
    AttitudeState applied(Quat world_from_body, Vec3d rate_body_rad_s, TimeTai time) const;

  private:
    struct Sinusoid {
        Vec3d amplitude_rad, rate_rad_s, phase_rad;  // by axis
    };
    std::vector<Sinusoid> sinusoids_;
    TimeTai start_;
};

}  // namespace hilcam
