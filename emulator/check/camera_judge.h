#pragma once
// Finds what is probably not meant in a camera's file in which nothing is out of range: a full well in
// thousands of electrons, a gain a hundred times too high, a black level that cuts off the noise in the dark.

#include <string>
#include <vector>

#include "emulator/check/camera_sheet.h"
#include "io/config/key_places.h"

namespace hilcam {

// A line each, with the key and its place. keeps_rate: frames come at the camera's frame rate, and are not asked for.
std::vector<std::string> judge_camera(const CameraSheet& sheet, bool keeps_rate, const KeyPlaces& places);

}  // namespace hilcam
