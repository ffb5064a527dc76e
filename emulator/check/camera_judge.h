#pragma once
// Finds probable mistakes in a camera file where every value is within its range: a full well in thousands of
// electrons, a gain a hundred times too high, a black level that cuts off dark noise.

#include <string>
#include <vector>

#include "emulator/check/camera_sheet.h"
#include "io/config/key_places.h"

namespace hilcam {

// Returns one line for each, with the key and its place. keeps_rate: frames come at the camera's own rate,
// not on request.
std::vector<std::string> judge_camera(const CameraSheet& sheet, bool keeps_rate, const KeyPlaces& places);

}  // namespace hilcam
