#pragma once
// Reads how frames were taken out of the names of folders and files: "dark_20ms_25c/0001.png",
// "flat_5ms_25c_light0.5_007.tiff".
//
// Words are separated by _ and /. Known ones: dark or bias, flat, edge, chessboard, lag; an exposure as
// 250us, 20ms or 1.5s; a temperature as 25c or -10c; a gain as 6db; light as light0.5; inner corners of a
// chessboard as 9x6. Others, such as a number, are not used.

#include <optional>
#include <string>
#include <string_view>

#include "emulator/clone/frames_config.h"

namespace hilcam {

// Returns the settings in a name without its ending; nothing when it does not say the kind. The exposure is 0
// when the name says none. Throws InputError when two words contradict each other. Any thread.
std::optional<SeriesConfig> settings_in_name(std::string_view name);

}  // namespace hilcam
