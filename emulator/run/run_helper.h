#pragma once
// Runs the programs beside this one that help it: they record frames, calibrate lenses, make pages.

#include <string>
#include <vector>

namespace hilcam {

// Runs the program of that name, with this one's standard input and output, and returns its exit status; -1
// when a signal ended it. Throws DeviceError when it is missing or cannot be started. without: what is not
// done then, for the message.
int run_helper(const std::string& name, const std::vector<std::string>& arguments,
               const std::string& without);

}  // namespace hilcam
