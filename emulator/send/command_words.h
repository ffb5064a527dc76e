#pragma once
// Commands as words: the subcommands of `hilcam send`, and the lines of a command script.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "io/contract/command.h"

namespace hilcam {

// Adds a subcommand for each command: ping, start, stop, settings, pose, joint, lamp, expose, mode, clock,
// fault. take: receives the chosen command after successful parsing. list_faults: called for "fault list",
// which is not a command, unless the function is empty.
void add_command_words(CLI::App& app, const std::function<void(const Command&)>& take,
                       const std::function<void()>& list_faults = {});

// Returns the command for words like "settings --exposure-ms 5". Throws when the words are not a command; the
// message says why.
Command command_of_words(const std::string& words);

// One line of a script: a time in seconds since the script's start, and a command.
struct ScriptLine {
    double at_s = 0;
    Command command;
    std::size_t number = 0;  // number of the line in its file
};
// Parses a script. Each line has an optional time ("@2.5" since the start, "+0.1" since the line before),
// then the words of a command as `hilcam send` accepts them. '#' begins a comment. Throws InputError that
// names the line.
std::vector<ScriptLine> parse_script(const std::string& text, const std::string& name);

}  // namespace hilcam
