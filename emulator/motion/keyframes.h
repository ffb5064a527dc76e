#pragma once
// Motion through keyframes: cubic Hermite in position, constant rate in attitude from one to the next.
//
// A keyframe without a velocity gets that of the parabola through it and its neighbours (the chord's at the
// ends), one without an attitude that of the one before.

#include <optional>
#include <vector>

#include "emulator/motion/motion_source.h"

namespace hilcam {

struct Keyframe {
    TimeTai time;
    Vec3d position_m;
    std::optional<Vec3d> velocity_m_s;
    std::optional<Quat> attitude;  // frame from body
};

class Keyframes {
  public:
    // Times must rise and there must be one at least: InputError.
    explicit Keyframes(const std::vector<Keyframe>& keyframes);

    // Returns the state; before the first and after the last keyframe it is as there, at rest. Loop.
    StateVector state_at(TimeTai time) const;
    AttitudeState attitude_at(TimeTai time) const;

  private:
    std::vector<Motion> motions_;  // in the keyframes' frame; the rate is that to the next one

    // The keyframe before an instant; nothing outside of them.
    const Motion* before(TimeTai time) const;
    const Motion& nearest(TimeTai time) const;
};

}  // namespace hilcam
