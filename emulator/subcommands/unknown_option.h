#pragma once
// Makes the message for a command line with words that its subcommand does not take.

#include <CLI/CLI.hpp>
#include <string>

namespace hilcam {

// "run: not expected: '--seed 1'; 'seed' is a key: --set seed=1". Names the nearest option where the word is a slip of the
// pen. Empty: no word is left over. The app has just failed to parse.
std::string unknown_option(const CLI::App& app);

}  // namespace hilcam
