#include "emulator/subcommands/option_tree.h"

#include <algorithm>
#include <regex>

#include "emulator/send/command_examples.h"

namespace hilcam {
namespace {

std::vector<std::string> split(const std::string& text, char mark) {
    std::vector<std::string> words;
    std::size_t begin = 0;
    for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
        end = text.find(mark, begin);
        words.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
    }
    return words;
}

std::string_view word_of(std::string_view kind) {
    return kind == "FLOAT" ? "NUMBER" : kind == "INT" || kind == "UINT" ? "N" : kind;
}

// CLI11 writes the kind of a value, then its checks: "INT:INT in [1 - 65535]", "TEXT:{on,off}".
void read_type(const std::string& type, OptionText& out) {
    const std::size_t colon = type.find(':');
    const std::string kind = type.substr(0, colon);
    const std::string check = colon == std::string::npos ? "" : type.substr(colon + 1);
    static const std::regex range(R"(\w+ in \[(\S+) - (\S+)\])");
    std::smatch ends;
    if (kind.find('|') != std::string::npos) {
        out.words = split(kind, '|');
    } else if (check.starts_with('{') && check.ends_with('}')) {
        out.words = split(check.substr(1, check.size() - 2), ',');
    } else if (std::regex_match(check, ends, range)) {
        out.accepted = ends[1].str() + " to " + ends[2].str();
    } else if (check == "POSITIVE") {
        out.accepted = "above 0";
    } else if (check == "NONNEGATIVE") {
        out.accepted = "0 or more";
    } else {
        out.accepted = check;
    }
    out.takes_files = kind == "TEXT" && out.words.empty();
    // Several values are written as "[FLOAT,FLOAT,FLOAT]".
    const bool several = kind.starts_with('[') && kind.ends_with(']');
    for (const std::string& one : split(several ? kind.substr(1, kind.size() - 2) : kind, ','))
        out.value += (out.value.empty() ? "" : " ") + std::string(word_of(one));
    if (!out.words.empty()) {
        out.value.clear();
        for (const std::string& word : out.words) out.value += (out.value.empty() ? "" : "|") + word;
    }
}

OptionText described(const CLI::Option& option) {
    OptionText out;
    out.is_positional = option.get_positional();
    if (out.is_positional) {
        out.names = {option.get_name(true)};
    } else {
        for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    }
    out.meaning = option.get_description();
    out.usual = option.get_default_str();
    out.is_required = option.get_required();
    if (option.get_items_expected_max() == 0) return out;
    read_type(option.get_type_name(), out);
    return out;
}

}  // namespace

CommandText described(const CLI::App& app) {
    CommandText out{app.get_name(), app.get_description(), {}, {}, examples_of(app)};
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty()) out.options.push_back(described(*option));
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!command->get_group().empty()) out.commands.push_back(described(*command));
    return out;
}

}  // namespace hilcam
