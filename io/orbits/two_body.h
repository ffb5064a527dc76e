#pragma once
// The motion of two bodies from a state: ellipses, parabolas and hyperbolas alike, by universal variables (Danby,
// Fundamentals of Celestial Mechanics, 2nd ed., 1988, section 6.9).

#include "render/sky/bodies.h"

namespace hilcam {

// Returns the state after `seconds`, either way. Any unit of length, in state and gravity (length^3/s^2, above 0). The
// state does not lie at the centre. Loop: no allocation.
StateVector two_body_state(const StateVector& state, double gravity, double seconds);

}  // namespace hilcam
