#pragma once
// tests/extremes/extremes.csv: written from what was measured, and read back to compare it with the suite. It has a
// line for each quantity of each case: table, varied, value, quantity, truth, error, limit.

#include <string>
#include <vector>

#include "tests/extremes/group.h"

namespace hilcam::extremes {

// What one case found; empty: it was not measured.
using Measured = std::vector<Found>;

// The line that names the columns.
std::string head_line();
// The lines of one table. measured: per case of the group.
std::string lines_of(const Group& group, const std::vector<Measured>& measured);

// Titles of the file's tables, in its order.
std::vector<std::string> titles_in(const std::string& file);
// Where the file differs from the suite: names, values and limits must be the same, truths the same to a percent, and
// the file's errors within their limits. Errors may differ, as their last digits depend on the machine. Empty when
// nothing differs.
std::vector<std::string> differences(const std::string& file, const Group& group,
                                     const std::vector<Measured>& measured);

}  // namespace hilcam::extremes
