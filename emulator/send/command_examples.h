#pragma once
// Examples at the end of a command's help: commands that work as written. Manual pages contain them, too.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// Sets a command's examples, as in "hilcam run small --frames 3". A line has at most 76 characters, so that
// no version of CLI11 breaks it.
void set_examples(CLI::App* command, const std::vector<std::string_view>& lines);

// Returns a command's examples; empty: none.
std::vector<std::string> examples_of(const CLI::App& command);

}  // namespace hilcam
