#pragma once
// Reports of `hilcam tradeoff`: CSV and JSON for scripts, presets, a page with plots, and a few lines for
// people.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// Returns a row for each measured setting, in the order of measurement. Columns: id, kind (own, single,
// combination), front (1: on the Pareto front), the figures, resolved (1: error_sigma_p99 is at least three
// times the reference's standard error), a column for each knob, and the values for `--set`. Empty: not
// applicable.
std::string tradeoff_csv(const Tradeoff& tradeoff);
nlohmann::json tradeoff_json(const Tradeoff& tradeoff);
// Returns the front, and the recommendations for the wanted frame time and error.
std::string tradeoff_text(const Tradeoff& tradeoff);

// Writes tradeoff.csv, tradeoff.json, the quality files realtime.yaml (least error within the frame time),
// balanced.yaml (fastest within the error) and reference.yaml, and loop.yaml (tradeoff_ladder.h); then
// index.html and its plots, which the program hilcam-plot-tradeoff in the same folder makes. Throws
// DeviceError when a file cannot be written or that program fails.
void write_tradeoff(const Tradeoff& tradeoff, const std::filesystem::path& folder);

}  // namespace hilcam
