#pragma once
// The machine that a figure was measured on, so that it can be judged.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hilcam {

// The processor's name as /proc/cpuinfo has it; "unknown" where it has none.
std::string processor_name();
// Processor, cores, compiler and build: the reports' object `machine`.
nlohmann::json machine_report();

}  // namespace hilcam
