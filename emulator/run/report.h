#pragma once
// Reports for scripts: the JSON of `run --report` and `bench --json`. Keys are part of the interface.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/broken_bounds.h"
#include "emulator/run/emulator.h"

namespace hilcam {

// Percentiles of durations, rounded to 0.1 us. The maximum is exact, the others are right within 2.2 %.
struct Percentiles {
    double p50_ms = 0, p99_ms = 0, p999_ms = 0, max_ms = 0;
};
Percentiles percentiles_of(const DurationHistogram& histogram);
void to_json(nlohmann::json& out, const Percentiles& percentiles);
// Percentiles of each stage, by the stage's name.
using StageTimes = std::map<std::string, Percentiles>;
StageTimes stage_times(const StageMeters& meters);
// Returns null for an empty value.
nlohmann::json or_null(const std::optional<double>& value);

// Outcome of a run: figures of the first camera, faults of all.
struct RunOutcome {
    std::uint64_t frames = 0, deadline_misses = 0;
    std::vector<std::string> faults;  // faults of all outputs and of the recording, one line each
    std::vector<BrokenBound> broken;  // bounds of loop.fail_on that cameras did not keep
};
RunOutcome run_outcome(const Emulator& emulator);
// Reports the whole run: the first camera's figures at the top level; with several cameras, each one's
// figures under `cameras`.
nlohmann::json run_report(const Emulator& emulator);
// Makes a folder for files before anything is measured for them. Throws DeviceError when that fails.
void make_folder(const std::filesystem::path& folder);
// Both throw DeviceError when the file cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);
void write_json(const std::filesystem::path& file, const nlohmann::json& json);

}  // namespace hilcam
