#pragma once
// The command line as data: what CLI11 knows of commands and options, in the words that people read. Manual
// pages and completions are made from it.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hilcam {

struct OptionText {
    std::vector<std::string> names;  // "-h", "--help"; of a positional argument its one name
    std::string value;               // "NUMBER", "TEXT", "on|off"; empty: it takes none
    std::string accepted;            // "1 to 65535"; empty: nothing more to say
    std::vector<std::string> words;  // that the value is one of; empty: anything
    std::string meaning;
    std::string usual;  // the value that holds without it; empty: not told
    bool is_positional = false, is_required = false, takes_files = false;
};

struct CommandText {
    std::string name;  // "pose"
    std::string meaning;
    std::vector<OptionText> options;
    std::vector<CommandText> commands;
    std::vector<std::string> examples;  // command lines (emulator/send/command_examples.h)
};

// A command with all below it, but for what is hidden (of the group ""). Owner thread.
CommandText described(const CLI::App& app);

}  // namespace hilcam
