#pragma once
// Motion near a thing on a circular orbit, in its LVLH axes (world_frame.h), to first order in the distance:
// Clohessy & Wiltshire, "Terminal guidance system for satellite rendezvous", J. Aerospace Sciences 27(9),
// 1960, in the axes and closed form of Fehse, Automated Rendezvous and Docking of Spacecraft, 2003, section
// 3.2. Neglected terms are of the order of (distance / orbit radius)^2 and of the orbit's eccentricity.

#include "render/sky/bodies.h"

namespace hilcam {

// Returns the state after free drift in LVLH. mean_motion_rad_s: above 0.
StateVector drifted(const StateVector& initial_lvlh, double mean_motion_rad_s, double seconds);

// Returns the mean motion of the orbit through a state about its centre (vis-viva). Throws InputError when
// the orbit is not closed.
double mean_motion_rad_s(const StateVector& about_center, double gravity_m3_s2);

}  // namespace hilcam
