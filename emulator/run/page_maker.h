#pragma once
// Runs the Python programs in this program's folder that make pages with plots of measurements.

#include <string>
#include <vector>

namespace hilcam {

// Runs the program of that name and waits for its end. Throws DeviceError when it is missing, cannot be
// started or fails; in the last case it has printed the reason on standard error.
void run_page_maker(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace hilcam
