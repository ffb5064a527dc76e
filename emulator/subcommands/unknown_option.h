#pragma once
// Returns the error message for a command line with words that its subcommand does not accept.

#include <CLI/CLI.hpp>
#include <string>

namespace hilcam {

// Returns, as an example, "run: not expected: '--seed 1'; 'seed' is a key: --set seed=1". Names the nearest
// option for a misspelt word. Empty: all words were accepted. Call right after the app failed to parse.
std::string unknown_option(const CLI::App& app);

}  // namespace hilcam
