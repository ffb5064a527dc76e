#pragma once
// Reference axes of CCSDS orbit and attitude messages (io/files/ccsds_message.h), relative to ICRF.

#include <optional>

#include "emulator/motion/world_frame.h"
#include "io/files/ccsds_message.h"

namespace hilcam {

// True for axes of the Earth, which only orbits about the Earth may use.
bool is_of_the_earth(CcsdsFrame frame);
// Returns axes that do not turn: EME2000, or TEME, TOD, MOD of an epoch; nothing for others. Calls ERFA, once
// for each message.
std::optional<Mat3d> resting_axes(CcsdsFrame frame, const std::optional<TimeTai>& epoch);
// Returns axes of date at the frame's instant, or ICRF for axes that are not the Earth's. The rates ignore
// that TEME, TOD and MOD turn by 50 arcsec a year (1e-11 rad/s). Loop.
TurningAxes axes_of_date(CcsdsFrame frame, const WorldFrame& world);

}  // namespace hilcam
