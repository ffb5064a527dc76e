#pragma once
// What `hilcam characterise` says: JSON for scripts, a table for engineers, a folder with curves and a page.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "emulator/characterise/characterise.h"

namespace hilcam {

// For each figure an object {configured, measured, uncertainty}; curves as lists of objects. A figure that
// the data sheet has no value for is configured null. `uncertainty` is one standard deviation.
nlohmann::json characterisation_json(const Characterisation& result, const DetectorPictures& pictures);
std::string characterisation_table(const nlohmann::json& report);

// characterise.json, a CSV file for each curve, and index.html, which the program hilcam-plot-characterise
// beside this one makes of the JSON. DeviceError when something cannot be written, or when that program fails
// (Python 3 or Matplotlib missing): then the other files are there.
void write_characterisation(const nlohmann::json& report, const std::filesystem::path& folder);

}  // namespace hilcam
