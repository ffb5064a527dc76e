#pragma once
// Reads and writes the list of one sensor's defective pixels: CSV (value_table_file.h) with the columns kind
// (hot, dead, blinking), x, y and value. A hot pixel's value is its dark current [e-/s], a blinking one's the
// difference of its two states [e-]; a dead pixel's is not used. Pixels are counted from 0.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/fixed_pattern.h"

namespace hilcam {

// Throw InputError, one line with the place: no such table, another kind, a place that is no whole number
// from 0 to 16383, a value that is negative or above 1e9.
std::vector<ListedDefect> read_defect_list(const std::filesystem::path& file);
std::vector<ListedDefect> parse_defect_list(std::string_view text, const std::string& name);

// Returns the file's text, which parse_defect_list() reads back.
std::string defect_list_text(const std::vector<ListedDefect>& defects);

}  // namespace hilcam
