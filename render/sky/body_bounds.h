#pragma once
// The bounds of motion (motion_bounds.h) for states of orbits and for the bodies of the sky. Loop.

#include "render/sky/bodies.h"
#include "render/sky/motion_bounds.h"

namespace hilcam {

inline bool is_possible(const StateVector& s) {
    return is_within(s.position_m, kFarthestPlace_m) && is_within(s.velocity_m_s, kFastestMotion_m_s);
}
// Copies what is possible from `found` to `kept`, which keeps its own values for the rest. A body may be two
// bounds away, because it and the origin may be on opposite sides; the Sun may be farther. Returns false if
// something was impossible.
bool take_possible(const Bodies& found, Bodies& kept);

}  // namespace hilcam
