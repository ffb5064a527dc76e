#pragma once
// The command line as data: commands and options from CLI11 in the words that people read. Manual pages and
// completions are made from it.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hilcam {

struct OptionText {
    std::vector<std::string> names;  // "-h", "--help"; for a positional argument, its only name
    std::string value;               // "NUMBER", "TEXT", "on|off"; empty: the option has no value
    std::string accepted;            // "1 to 65535"; empty: any value
    std::vector<std::string> words;  // the only accepted values; empty: not limited to words
    std::string meaning;
    std::string usual;  // value when the option is not given; empty: unknown
    bool is_positional = false, is_required = false, takes_files = false;
};

struct CommandText {
    std::string name;  // "pose"
    std::string meaning;
    std::vector<OptionText> options;
    std::vector<CommandText> commands;
    std::vector<std::string> examples;  // command lines (emulator/send/command_examples.h)
};

// Returns a command with all its subcommands, without hidden ones (in the group ""). Owner thread.
CommandText described(const CLI::App& app);

}  // namespace hilcam
