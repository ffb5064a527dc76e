#pragma once
// The report of `hilcam characterise`: JSON for scripts, a table for engineers, a folder with curves and a
// page.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/characterise/characterise.h"

namespace hilcam {

// A figure that the data sheet says and the laboratory measures.
struct SheetFigure {
    const char* key;    // in the JSON
    const char* label;  // in the table; null: it is not there
    const char* unit;   // in the table
    double factor;      // from the figure to the table's unit
    double configured;  // NaN or infinity where the data sheet gives none
    Measured measured;  // measurement with one standard deviation
};
// Returns the figures in the table's order.
std::vector<SheetFigure> sheet_figures(const Characterisation& result, const DetectorPictures& pictures);

// Returns for each figure an object {configured, measured, uncertainty}, and curves as lists of objects. A
// figure that the data sheet has no value for is configured null.
nlohmann::json characterisation_json(const Characterisation& result, const DetectorPictures& pictures);
std::string characterisation_table(const Characterisation& result, const DetectorPictures& pictures);

// characterise.json, a CSV file for each curve, and index.html, which the program hilcam-plot-characterise
// beside this one makes of the JSON. DeviceError when something cannot be written, or when that program fails
// (Python 3 or Matplotlib missing): then the other files are there.
void write_characterisation(const Characterisation& result, const DetectorPictures& pictures,
                            const std::filesystem::path& folder);

}  // namespace hilcam
