#pragma once
// Describes the machine on which figures were measured.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hilcam {

// Returns the processor's name from /proc/cpuinfo, or "unknown".
std::string processor_name();
// Returns the object `machine` of reports: processor, cores, compiler and build.
nlohmann::json machine_report();

}  // namespace hilcam
