#pragma once
// Prints a recording as JSON lines for people and scripts: `hilcam recording FILE`.

#include <functional>
#include <string>

#include "emulator/recording/recording_reader.h"

namespace hilcam {

// Passes on the header, a line for each record, and the end. Times are seconds since the run began.
void list_recording(RecordingReader& recording, const std::function<void(const std::string&)>& line);

}  // namespace hilcam
