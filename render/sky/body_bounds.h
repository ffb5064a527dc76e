#pragma once
// The bounds of motion (motion_bounds.h) for the states of orbits and for the bodies of the sky. Loop.

#include "render/sky/bodies.h"
#include "render/sky/motion_bounds.h"

namespace hilcam {

inline bool is_possible(const StateVector& s) {
    return is_within(s.position_m, kFarthestPlace_m) && is_within(s.velocity_m_s, kFastestMotion_m_s);
}
// Takes over what can be of the bodies: at most two bounds away, as body and origin may be opposite each other; the Sun may be
// farther. Of the others `kept`
// keeps its own. False: something could not be.
bool take_possible(const Bodies& found, Bodies& kept);

}  // namespace hilcam
