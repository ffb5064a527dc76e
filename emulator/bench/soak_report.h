#pragma once
// The report of `hilcam bench --soak`: a line for people, CSV, JSON and a page for a closer look.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/bench/soak.h"

namespace hilcam {

// A line for each slice: start_s, length_s, frames, deadline_misses, memory_mb, then work_, interval_ and
// latency_ with p50_ms, p99_ms, p99.9_ms and max_ms of each.
std::string soak_csv(const Soak& soak);
nlohmann::json soak_json(const ScenarioConfig& scenario, const SoakOptions& options, const Soak& soak);
// Says in a line whether memory was flat and latency steady, with the figures.
std::string soak_text(const Soak& soak);

// soak.csv, soak.json, and index.html with its plot (soak.svg), which the program hilcam-plot-soak beside
// this one makes. DeviceError when something cannot be written or that program fails.
void write_soak(const Soak& soak, const nlohmann::json& json, const std::filesystem::path& folder);

}  // namespace hilcam
