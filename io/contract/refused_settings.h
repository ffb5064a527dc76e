#pragma once
// Why the camera refuses a change of its settings, in words for a sender or an HTTP client. A command's
// answer has room for 96 bytes (io/commands/acknowledgement.h).

#include <string>

#include "io/contract/camera_control.h"

namespace hilcam {

// Returns the first value outside its limits, "exposure_s: found 5; accepted: 1e-05 to 1", or what else
// prevents the change. now: the present settings, which stay.
std::string refusal_of(const SettingsChange& change, const CameraSettings& now, const CameraLimits& limits);

}  // namespace hilcam
