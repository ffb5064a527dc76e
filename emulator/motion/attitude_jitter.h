#pragma once
// Jitter of a body's attitude: small rotations about its axes, a pure function of time, seed and thing.
//
// The band is cut into kSinusoids equal parts for each axis. A sinusoid has a random frequency in each part,
// a Rayleigh amplitude and a random phase. Over seeds, the angle at any instant is Gaussian with the given
// deviation, and the spectrum is flat over the band. Correlation between axes is not modelled. The camera's
// line of sight may jitter in addition (sensor/motion.h).

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

    // Makes jitter that does nothing.
    AttitudeJitter() = default;
    // Times are counted from `start`. Owner thread.
    AttitudeJitter(const JitterBand& band, std::uint64_t seed, std::uint32_t thing, TimeTai start);

    // Returns attitude and body rate including jitter, to first order in the angles: their products are left
    // out. Loop.
    AttitudeState applied(Quat world_from_body, Vec3d rate_body_rad_s, TimeTai time) const;

  private:
    struct Sinusoid {
        Vec3d amplitude_rad, rate_rad_s, phase_rad;  // by axis
    };
    std::vector<Sinusoid> sinusoids_;
    TimeTai start_;
};

}  // namespace hilcam
