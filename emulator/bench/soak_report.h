#pragma once
// Reports of `hilcam bench --soak`: one line for people, CSV, JSON, and a page with a plot.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/bench/soak.h"

namespace hilcam {

// A row for each slice: start_s, length_s, frames, deadline_misses, memory_mb, then p50_ms, p99_ms, p99.9_ms
// and max_ms, each with the prefixes work_, interval_ and latency_.
std::string soak_csv(const Soak& soak);
nlohmann::json soak_json(const ScenarioConfig& scenario, const SoakOptions& options, const Soak& soak);
// Says in one line, with figures, whether memory was flat and latency steady.
std::string soak_text(const Soak& soak);

// Writes soak.csv, soak.json, and index.html with its plot soak.svg, which the program hilcam-plot-soak in
// the same folder draws. Throws DeviceError when a file cannot be written or that program fails.
void write_soak(const Soak& soak, const nlohmann::json& json, const std::filesystem::path& folder);

}  // namespace hilcam
