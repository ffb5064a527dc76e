#pragma once
// Motion near a thing on a circular orbit, in its LVLH axes (world_frame.h), first order in the distance:
// Clohessy & Wiltshire, "Terminal guidance system for satellite rendezvous", J. Aerospace Sciences 27(9),
// 1960, in the axes and closed form of Fehse, Automated Rendezvous and Docking of Spacecraft, 2003,
// section 3.2. What is left out is of the size of (distance / orbit radius)^2 and of the orbit's
// eccentricity.

#include "render/sky/bodies.h"

namespace hilcam {

// Free drift from an initial state in LVLH: seconds later, at a mean motion above 0.
StateVector drifted(const StateVector& initial_lvlh, double mean_motion_rad_s, double seconds);

// The mean motion of the orbit that passes through a state about its centre (vis-viva). InputError when it is
// not closed.
double mean_motion_rad_s(const StateVector& about_center, double gravity_m3_s2);

}  // namespace hilcam
