#pragma once
// Sets up the program's log on standard error: lines that begin with "hilcam: ", without control characters.

namespace hilcam {

// Makes spdlog write to this log. Messages may quote files, command lines and network data, so everything is
// made harmless once more here (render/vocabulary/quoted.h), in case a caller forgot. Also makes uncaught
// exceptions a line in the log, with the name of the thread they end. Call once, before the first message.
void set_up_log();

}  // namespace hilcam
