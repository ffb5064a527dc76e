#pragma once
// The report of `hilcam tradeoff`: CSV and JSON for scripts, presets, a page with plots, and a few lines for
// people.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// A line for each measured setting, in the order of measuring. Columns: id, kind (own, single, combination),
// front (1: on the Pareto front), the figures, resolved (1: error_sigma_p99 is at least three times the
// reference's own standard error), a column for each knob, and what `--set` takes. Empty: not applicable.
std::string tradeoff_csv(const Tradeoff& tradeoff);
nlohmann::json tradeoff_json(const Tradeoff& tradeoff);
// The front, and what is recommended for the frame time and the error that were asked for.
std::string tradeoff_text(const Tradeoff& tradeoff);

// tradeoff.csv, tradeoff.json, quality files realtime.yaml (the least error within the frame time),
// balanced.yaml (the fastest within the error) and reference.yaml, loop.yaml (tradeoff_ladder.h); then
// index.html and its plots, which the program hilcam-plot-tradeoff beside this one makes. DeviceError when
// something cannot be written or that program fails.
void write_tradeoff(const Tradeoff& tradeoff, const std::filesystem::path& folder);

}  // namespace hilcam
