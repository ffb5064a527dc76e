// `hilcam list`: lists the shipped parts that can be named by a word.

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

struct ListArguments {
    std::string kind;  // empty: all
    bool json = false;
};

std::string list_json(const std::vector<const ShippedKind*>& kinds) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const ShippedKind* kind : kinds)
        for (const ShippedPart& part : shipped_parts(*kind))
            out.push_back({{"kind", kind->words},
                           {"name", part.name},
                           {"about", part.about},
                           {"file", part.file.string()}});
    return out.dump(2) + "\n";
}

std::string list_text(const std::vector<const ShippedKind*>& kinds) {
    std::string out;
    for (const ShippedKind* kind : kinds) {
        out += fmt::format("{}{}: {}\n", out.empty() ? "" : "\n", kind->words, kind->use);
        for (const ShippedPart& part : shipped_parts(*kind)) {
            const std::string about = part.about.empty() ? part.file.filename().string() : part.about;
            out += fmt::format("  {:<20} {}\n", part.name, about);
        }
    }
    return out;
}

int carry_out(const ListArguments& o) {
    std::vector<const ShippedKind*> kinds;
    for (const ShippedKind& kind : shipped_kinds())
        if (o.kind.empty() || kind.words == o.kind) kinds.push_back(&kind);
    if (const std::string why = without_shipped_parts(); !why.empty()) throw DeviceError("list: " + why);
    fmt::print("{}", o.json ? list_json(kinds) : list_text(kinds));
    return 0;
}

}  // namespace

void add_list_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<ListArguments>();
    CLI::App* list =
        app.add_subcommand("list", "list what is shipped and goes by its name, with a line on each");
    std::vector<std::string> words;
    for (const ShippedKind& kind : shipped_kinds()) words.emplace_back(kind.words);
    list->add_option("kind", o->kind, "kind to list; left out: all")->check(CLI::IsMember(words));
    list->add_flag("--json", o->json, "machine-readable");
    set_examples(list, {"hilcam list", "hilcam list cameras", "hilcam list materials --json"});
    when_named(list, action, o, carry_out);
}

}  // namespace hilcam
