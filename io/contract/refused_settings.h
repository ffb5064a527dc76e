#pragma once
// Why the camera refuses a change of its settings, in words for whoever asked by a command or over HTTP. A command's
// answer has room for 96 bytes (io/commands/acknowledgement.h).

#include <string>

#include "io/contract/camera_control.h"

namespace hilcam {

// "exposure_s: found 5; accepted: 1e-05 to 1". now: the settings that stay as they are. Where no value is
// outside its limits: that it cannot be set now.
std::string refusal_of(const SettingsChange& change, const CameraSettings& now, const CameraLimits& limits);

}  // namespace hilcam
