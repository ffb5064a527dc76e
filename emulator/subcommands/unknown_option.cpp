#include "emulator/subcommands/unknown_option.h"

#include <algorithm>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "io/config/config_advice.h"
#include "io/config/config_keys.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Returns the only key with that name: "camera.exposure_ms" for "exposure_ms". Empty: none, or several.
std::string key_named(const std::string& name) {
    ScenarioConfig scenario;
    std::string found;
    std::size_t count = 0;
    for (const std::string& key : config_keys(fields(scenario))) {
        if (key == name) return key;
        if (key.ends_with("." + name) && key.find(".N.") == std::string::npos) found = key, ++count;
    }
    return count == 1 ? found : "";
}

std::vector<std::string> options_of(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// value: the word after the option; empty: none.
std::string advice(const CLI::App& command, const std::string& word, const std::string& value) {
    const std::string option = word.substr(0, word.find('='));
    const std::vector<std::string> options = options_of(command);
    const bool takes_keys = std::find(options.begin(), options.end(), "--set") != options.end();
    std::string name = option.substr(std::min(option.find_first_not_of('-'), option.size()));
    std::replace(name.begin(), name.end(), '-', '_');
    if (const std::string key = takes_keys ? key_named(name) : ""; !key.empty())
        return "; " + in_quotes(key) + " is a key of the scenario: --set " + key + "=" +
               (value.empty() ? "VALUE" : harmless(value));
    // A misspelling usually keeps the first letter.
    if (const std::string nearest = nearest_of(option, options); nearest.substr(0, 3) == option.substr(0, 3))
        return "; nearest: " + nearest;
    return "; 'hilcam " + command.get_name() + " --help' lists what is accepted";
}

}  // namespace

std::string unknown_option(const CLI::App& app) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const std::vector<std::string> left = command->remaining();
    const auto word =
        std::find_if(left.begin(), left.end(), [](const std::string& w) { return w.starts_with("-"); });
    if (word == left.end()) return {};
    const std::size_t equals = word->find('=');
    const std::string value = equals != std::string::npos ? word->substr(equals + 1)
                              : word + 1 != left.end() && !(word + 1)->starts_with("-") ? *(word + 1)
                                                                                        : "";
    std::string all;
    for (const std::string& w : left) all += (all.empty() ? "" : " ") + w;
    return command->get_name() + ": not expected: " + in_quotes(all) + advice(*command, *word, value);
}

}  // namespace hilcam
