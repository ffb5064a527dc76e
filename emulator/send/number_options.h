#pragma once
// Numbers on the command line are read as they are written. CLI11 alone takes -1 for the largest unsigned number, 010 for
// 8, what is too large for the largest there is, and nan for a number within any range.

#include <CLI/CLI.hpp>

namespace hilcam {

// Has every option of the app and of its subcommands, whose value is one number or several, refuse what is no decimal
// number: whole where the option's variable is, 0 or more where that has no sign, and finite. Is called when all options
// have been added.
void read_numbers_strictly(CLI::App& app);

}  // namespace hilcam
