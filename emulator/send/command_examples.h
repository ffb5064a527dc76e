#pragma once
// Examples at the end of a command's help: commands that work as they are written. Manual pages have them, too.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// Sets a command's examples: "hilcam run small --frames 3", each a line of 76 characters at most, which no
// version of CLI11 breaks.
void set_examples(CLI::App* command, const std::vector<std::string_view>& lines);

// Returns a command's examples; empty: it has none.
std::vector<std::string> examples_of(const CLI::App& command);

}  // namespace hilcam
