#pragma once
// Reports that scripts read: the JSON of `run --report` and `bench --json`. Keys are part of the interface.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/emulator.h"

namespace hilcam {

// Processor, cores, compiler and build, so that a figure can be judged.
nlohmann::json machine_report();
// Median and 99th percentile of every stage [ms].
nlohmann::json stages_report(const StageMeters& meters);
// Share of the lit pixels of all frames whose rendering error was within the noise budget; null without one.
nlohmann::json within_budget(const LoopCounters& counters);
// Of the whole run: the first camera's figures at the top, with several cameras each one's under `cameras`.
nlohmann::json run_report(const Emulator& emulator);
// Throws DeviceError when the file cannot be written.
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

}  // namespace hilcam
