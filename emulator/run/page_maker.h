#pragma once
// The Python programs beside this one that make pages with plots of what it has measured.

#include <string>
#include <vector>

namespace hilcam {

// Starts the program of that name and waits for its end. DeviceError when it is missing, cannot be started,
// or fails: it has then said why on standard error.
void run_page_maker(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace hilcam
