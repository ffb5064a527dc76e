#pragma once
// Motion through keyframes: cubic Hermite interpolation of position, constant rate of rotation between
// attitudes.
//
// A keyframe without a velocity gets that of the parabola through it and its neighbours; at either end, that
// of the chord. A keyframe without an attitude keeps that of the one before.

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
    // Requires at least one keyframe and rising times; throws InputError otherwise.
    explicit Keyframes(const std::vector<Keyframe>& keyframes);

    // Returns the state. Before the first and after the last keyframe, it is that keyframe's, at rest. Loop.
    StateVector state_at(TimeTai time) const;
    AttitudeState attitude_at(TimeTai time) const;

  private:
    std::vector<Motion> motions_;  // in the keyframes' frame; each rate leads to the next keyframe

    // Returns the keyframe before an instant, or null outside the keyframes' span.
    const Motion* before(TimeTai time) const;
    const Motion& nearest(TimeTai time) const;
};

}  // namespace hilcam
