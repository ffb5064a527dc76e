#pragma once
// The program's log on standard error: "hilcam: " and a line of text that no terminal obeys.

namespace hilcam {

// Makes it what spdlog writes to. Messages quote files, command lines and the wire: what each of them holds
// is made harmless here once more (render/vocabulary/quoted.h), so that none is forgotten. Call it once,
// before the first message. From then on also what an exception that nobody catches has to say is a line there, with the
// name of the thread that it ends.
void set_up_log();

}  // namespace hilcam
