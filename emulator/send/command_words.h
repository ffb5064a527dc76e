#pragma once
// Commands as words: the subcommands of `hilcam send`, and the lines of a command script.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "io/contract/command.h"

namespace hilcam {

// Adds a subcommand for each command: ping, start, stop, settings, pose, joint, lamp, expose, mode,
// clock, fault.
// `take` gets the one that was chosen, when parsing ends well; `list_faults` is called for "fault list",
// which is no command, unless it is empty.
void add_command_words(CLI::App& app, const std::function<void(const Command&)>& take,
                       const std::function<void()>& list_faults = {});

// The command of such words: "settings --exposure-ms 5". Throws what says why it is none.
Command command_of_words(const std::string& words);

// One line of a script: when, and what. Times are seconds since the script's start.
struct ScriptLine {
    double at_s = 0;
    Command command;
    std::size_t number = 0;  // number of the line in its file
};
// A script: on each line an optional time ("@2.5" since the start, "+0.1" since the line before), then the
// words of a command as `hilcam send` takes them. '#' begins a comment. Throws InputError that names the
// line.
std::vector<ScriptLine> parse_script(const std::string& text, const std::string& name);

}  // namespace hilcam
