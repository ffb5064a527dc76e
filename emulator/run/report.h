#pragma once
// Reports that scripts read: the JSON of `run --report` and `bench --json`. Keys are part of the interface.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/run/emulator.h"

namespace hilcam {

// p50, p99, p99.9 and max [ms].
nlohmann::json percentiles_report(const DurationHistogram& histogram);
// The same of every stage.
nlohmann::json stages_report(const StageMeters& meters);
// Share of the lit pixels of all frames whose rendering error was within the noise budget; null without one.
nlohmann::json within_budget(const LoopCounters& counters);
// Of the whole run: the first camera's figures at the top, with several cameras each one's under `cameras`.
nlohmann::json run_report(const Emulator& emulator);
// A folder for files, before anything is measured for them. Throws DeviceError when it cannot be made.
void make_folder(const std::filesystem::path& folder);
// These throw DeviceError when the file cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

}  // namespace hilcam
