#pragma once
// A recording as JSON lines, for people and their scripts: `hilcam recording FILE`.

#include <functional>
#include <string>

#include "emulator/recording/recording_reader.h"

namespace hilcam {

// The header, a line per record, and where it ends. Times are seconds since the run began.
void list_recording(RecordingReader& recording, const std::function<void(const std::string&)>& line);

}  // namespace hilcam
