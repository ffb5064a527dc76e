#pragma once
// Command-line options that take one of a few words, and what is said of a subcommand that there is none of.

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace hilcam {

// Adds an option whose help lists its words: "--stage radiance|electrons|frame".
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

// Makes the message for a command line that has a word in the place of a subcommand where there is none of
// that name: what was found, the nearest name, all names. Empty: that is not what was wrong. The app has just
// failed to parse.
std::string unknown_subcommand(const CLI::App& app);

}  // namespace hilcam
