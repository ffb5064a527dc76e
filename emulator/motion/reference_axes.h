#pragma once
// The axes that orbit and attitude messages are written in (io/files/ccsds_message.h), against ICRF.

#include <optional>

#include "emulator/motion/world_frame.h"
#include "io/files/ccsds_message.h"

namespace hilcam {

// True for those of the Earth, in which only orbits about it are given.
bool is_of_the_earth(CcsdsFrame frame);
// Axes that stand still: EME2000, and TEME, TOD, MOD of an epoch. Nothing for others. With ERFA: once a message.
std::optional<Mat3d> resting_axes(CcsdsFrame frame, const std::optional<TimeTai>& epoch);
// Axes of date at the frame's instant; ICRF's for those that are none of the Earth's. TEME, TOD and MOD turn by 50 arcsec a
// year, 1e-11 rad/s, which is left out of rates. Loop.
TurningAxes axes_of_date(CcsdsFrame frame, const WorldFrame& world);

}  // namespace hilcam
