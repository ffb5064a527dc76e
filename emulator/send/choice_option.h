#pragma once
// Command-line options that accept one of a few words, and the error message for an unknown subcommand.

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace hilcam {

// Adds an option that lists its words in its help: "--stage radiance|electrons|frame".
template <class E>
CLI::Option* add_choice(CLI::App& app, const std::string& name, E& value,
                        const std::vector<std::pair<std::string, E>>& words, const std::string& help) {
    std::string list;
    for (const auto& [word, meaning] : words) list += (list.empty() ? "" : "|") + word;
    const auto take = [name, &value, words, list](const std::string& given) {
        for (const auto& [word, meaning] : words)
            if (word == given) return void(value = meaning);
        throw CLI::ValidationError(name, "found '" + given + "'; accepted: " + list);
    };
    return app.add_option_function<std::string>(name, take, help)->type_name(list);
}

// Returns the message for a command line with an unknown subcommand: what was found, the nearest name, all
// names. Empty when something else was wrong. Call right after the app failed to parse.
std::string unknown_subcommand(const CLI::App& app);

}  // namespace hilcam
