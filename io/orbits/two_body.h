#pragma once
// Two-body motion from a state, for ellipses, parabolas and hyperbolas alike, by universal variables (Danby,
// Fundamentals of Celestial Mechanics, 2nd ed., 1988, section 6.9).

#include "render/sky/bodies.h"

namespace hilcam {

// Returns the state after `seconds`, which may be negative. State and gravity share any unit of length;
// gravity is in length^3/s^2 and above 0. The initial position is not at the centre. Loop: no allocation.
StateVector two_body_state(const StateVector& state, double gravity, double seconds);

}  // namespace hilcam
