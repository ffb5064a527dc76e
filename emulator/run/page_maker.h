#pragma once
// Runs the programs in this program's folder: those in Python that make pages with plots of measurements, and
// others that help.

#include <string>
#include <vector>

namespace hilcam {

// Runs the program of that name, with this one's standard input and output, and returns its exit status; -1
// when a signal ended it. Throws DeviceError when it is missing or cannot be started. without: what is not
// done then, for the message.
int run_helper(const std::string& name, const std::vector<std::string>& arguments,
               const std::string& without);

// Runs the program of that name and waits for its end. Throws DeviceError when it is missing, cannot be
// started or fails; in the last case it has printed the reason on standard error.
void run_page_maker(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace hilcam
