#include "emulator/send/choice_option.h"

#include <algorithm>

#include "io/config/config_advice.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

std::string unknown_subcommand(const CLI::App& app) {
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
    std::vector<std::string> names;
    std::string list;
    for (const CLI::App* sub : last->get_subcommands([](const CLI::App*) { return true; })) {
        if (sub->get_group().empty()) continue;  // hidden
        names.push_back(sub->get_name());
        list += " " + sub->get_name();
    }
    const std::vector<std::string> left = last->remaining();
    const auto word =
        std::find_if(left.begin(), left.end(), [](const std::string& w) { return !w.starts_with('-'); });
    if (names.empty() || word == left.end()) return {};
    const std::string nearest = nearest_of(*word, names);
    return "unknown subcommand " + in_quotes(*word) + (nearest.empty() ? "" : "; nearest: " + nearest) +
           "; accepted:" + list;
}

}  // namespace hilcam
