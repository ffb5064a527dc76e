#pragma once
// Strict numbers on the command line. CLI11 alone reads -1 as the largest unsigned number and 010 as 8, clips
// values that are too large, and accepts nan within any range.

#include <CLI/CLI.hpp>

namespace hilcam {

// Makes every numeric option of the app and its subcommands refuse text that is not a finite decimal number,
// whole for integer variables, and at least 0 for unsigned ones. Call after all options have been added.
void read_numbers_strictly(CLI::App& app);

}  // namespace hilcam
