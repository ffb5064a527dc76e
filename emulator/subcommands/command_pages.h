#pragma once
// Manual pages and shell completion of a command line, made from its option tree. Pure: text in, text out.

#include <string>
#include <vector>

#include "emulator/subcommands/option_tree.h"

namespace hilcam {

struct NamedText {
    std::string name, text;
};

// "hilcam.1", and "hilcam-run.1" for each subcommand with those below it, in the macros of man(7).
// version: "hilcam 0.2.0".
std::vector<NamedText> manual_pages(const CommandText& program, const std::string& version);

// A script for bash that completes subcommands, options, their words, files, and in the place of a
// configuration the shipped ones. keys: of a scenario, "objects.N.mesh", for --set and manual.
std::string bash_completion(const CommandText& program, const std::vector<std::string>& keys);

}  // namespace hilcam
