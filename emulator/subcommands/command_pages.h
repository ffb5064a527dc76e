#pragma once
// Makes manual pages and shell completion from a command line's option tree. Pure functions on text.

#include <string>
#include <vector>

#include "emulator/subcommands/option_tree.h"

namespace hilcam {

struct NamedText {
    std::string name, text;
};

// Returns "hilcam.1", and a page like "hilcam-run.1" for each subcommand including its own subcommands, in
// the macros of man(7). version: "hilcam 0.3.0".
std::vector<NamedText> manual_pages(const CommandText& program, const std::string& version);

// Returns a bash script that completes subcommands, options, their words, files, and names of shipped
// configurations. keys: keys of a scenario, like "objects.N.mesh", for --set and manual.
std::string bash_completion(const CommandText& program, const std::vector<std::string>& keys);

}  // namespace hilcam
