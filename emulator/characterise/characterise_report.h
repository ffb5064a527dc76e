#pragma once
// Reports of `hilcam characterise`: JSON for scripts, a table for engineers, and a folder with curves and a
// page.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/characterise/characterise.h"

namespace hilcam {

// A figure that the data sheet states and the laboratory measures.
struct SheetFigure {
    const char* key;    // name in the JSON
    const char* label;  // name in the table; null: not in the table
    const char* unit;   // unit in the table
    double factor;      // converts the figure to the table's unit
    double configured;  // NaN or infinity when the data sheet gives no value
    Measured measured;  // measurement with one standard deviation
};
// Returns the figures in the table's order.
std::vector<SheetFigure> sheet_figures(const Characterisation& result, const DetectorPictures& pictures);

// Returns an object {configured, measured, uncertainty} for each figure, and curves as lists of objects.
// `configured` is null when the data sheet gives no value.
nlohmann::json characterisation_json(const Characterisation& result, const DetectorPictures& pictures);
std::string characterisation_table(const Characterisation& result, const DetectorPictures& pictures);

// Writes characterise.json, a CSV file for each curve, and index.html, which the program
// hilcam-plot-characterise in the same folder makes from the JSON. Throws DeviceError when a file cannot be
// written or that program fails (Python 3 or Matplotlib missing); in the latter case the other files exist.
void write_characterisation(const Characterisation& result, const DetectorPictures& pictures,
                            const std::filesystem::path& folder);

}  // namespace hilcam
