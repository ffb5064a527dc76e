#pragma once
// Commands as words: the subcommands of `hilcam send`, and the lines of a command script.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "io/command.h"

namespace hilcam {

// Adds a subcommand for each command: ping, start, stop, settings, pose, joint, expose, mode, fault. `take`
// gets the one that was chosen, when parsing ends well.
void add_command_words(CLI::App& app, const std::function<void(const Command&)>& take);

// One line of a script: when, and what. Times are seconds since the script's start.
struct ScriptLine {
    double at_s = 0;
    Command command;
    std::size_t number = 0;  // of the line in its file
};
// A script: on each line an optional time ("@2.5" since the start, "+0.1" since the line before), then the
// words of a command as `hilcam send` takes them. '#' begins a comment. Throws InputError that names the
// line.
std::vector<ScriptLine> parse_script(const std::string& text, const std::string& name);

}  // namespace hilcam
