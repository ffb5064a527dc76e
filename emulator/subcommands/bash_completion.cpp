#include <spdlog/fmt/fmt.h>

#include "emulator/subcommands/command_pages.h"
#include "io/contract/fault.h"

namespace hilcam {
namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
    return out;
}

// Returns the words for an option's value; "-" stands for files.
std::string value_words(const std::string& name, const OptionText& o) {
    if (name == "--set") return "@set";
    return o.words.empty() ? (o.takes_files ? "-" : "") : joined(o.words);
}

// Returns the completions of a positional argument: words, or the name of a list that is made on demand.
std::string argument_words(const std::string& path, const OptionText& o) {
    const std::string& name = o.names.front();
    if (path == "manual") return "@keys";
    if (path == "check" && name == "config") return "@config @camera";
    if (name == "config" || name == "camera") return "@" + name;
    if (path == "send fault") {
        std::vector<std::string> words = {"list", "clear"};
        for (const FaultKind kind : kAllFaults) words.emplace_back(name_of(kind));
        return joined(words);
    }
    return value_words(name, o);
}

// One table line for each command, keyed by its path of words, "send pose".
struct Tables {
    std::string commands, options, values, arguments;
};

void add(const CommandText& command, const std::string& path, Tables& out) {
    std::vector<std::string> names, below;
    std::string arguments;
    for (const OptionText& o : command.options) {
        if (o.is_positional) {
            arguments += (arguments.empty() ? "" : " ") + argument_words(path, o);
            continue;
        }
        for (const std::string& name : o.names) {
            names.push_back(name);
            if (!o.value.empty())
                out.values += fmt::format("    ['{} {}']='{}'\n", path, name, value_words(name, o));
        }
    }
    for (const CommandText& next : command.commands) {
        below.push_back(next.name);
        add(next, path.empty() ? next.name : path + " " + next.name, out);
    }
    // Bash does not allow empty keys.
    const std::string key = path.empty() ? "." : path;
    if (!below.empty()) out.commands += fmt::format("    ['{}']='{}'\n", key, joined(below));
    out.options += fmt::format("    ['{}']='{}'\n", key, joined(names));
    if (!arguments.empty()) out.arguments += fmt::format("    ['{}']='{}'\n", key, arguments);
}

constexpr const char* kFunction = R"~(
# The names of shipped files of a kind, "scenarios" or "cameras", which lie beside the program's own folder.
_hilcam_shipped() {
    local program folder file
    program=$(type -P "${COMP_WORDS[0]}") || return 0
    folder=$(dirname "$(readlink -f "$program")")/../share/hilcam/$1
    for file in "$folder"/*.yaml; do
        if [ -e "$file" ]; then basename "$file" .yaml; fi
    done
}

_hilcam_files() {
    compopt -o filenames 2>/dev/null
    local line
    while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "$1")
}

_hilcam() {
    local current=${COMP_WORDS[COMP_CWORD]} path=. option='' i word key
    COMPREPLY=()
    # Which command: words that are names of commands, after the program's. An option's value is none.
    for ((i = 1; i < COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [ -n "$option" ]; then option=''; continue; fi
        key="${path#.} $word"
        if [[ $word == -* ]]; then
            if [ -n "${_hilcam_values[$key]+set}" ]; then option=$key; fi
        elif [[ " ${_hilcam_commands[$path]-} " == *" $word "* ]]; then
            if [ "$path" = . ]; then path=$word; else path+=" $word"; fi
        fi
    done
    local words
    if [ -n "$option" ]; then
        words=${_hilcam_values[$option]-}
    elif [[ $current == -* ]]; then
        words=${_hilcam_options[$path]-}
    elif [ -n "${_hilcam_commands[$path]-}" ]; then
        words=${_hilcam_commands[$path]-}
    else
        words=${_hilcam_arguments[$path]-}
    fi
    for word in $words; do
        case $word in
            -) _hilcam_files "$current" ;;
            @config) _hilcam_files "$current"; COMPREPLY+=($(compgen -W "$(_hilcam_shipped scenarios)" -- "$current")) ;;
            @keys) COMPREPLY+=($(compgen -W "$_hilcam_keys" -- "$current")) ;;
            @set)
                compopt -o nospace 2>/dev/null
                COMPREPLY+=($(compgen -S = -W "${_hilcam_keys//.N/.0}" -- "$current"))
                ;;
            @camera) _hilcam_files "$current"; COMPREPLY+=($(compgen -W "$(_hilcam_shipped cameras)" -- "$current")) ;;
            *) COMPREPLY+=($(compgen -W "$word" -- "$current")) ;;
        esac
    done
}
complete -F _hilcam hilcam
)~";

}  // namespace

std::string bash_completion(const CommandText& program, const std::vector<std::string>& keys) {
    Tables tables;
    add(program, "", tables);
    return fmt::format(
               "# bash completion of hilcam, made from its options. Keys: words of the command, and an "
               "option's name.\n"
               "# '-' stands for files, '@config' and '@camera' for files and shipped ones, '@keys' and "
               "'@set' for a scenario's keys.\n"
               "declare -gA _hilcam_commands=(\n{})\ndeclare -gA _hilcam_options=(\n{})\n"
               "declare -gA _hilcam_values=(\n{})\ndeclare -gA _hilcam_arguments=(\n{})\n"
               "_hilcam_keys='{}'\n",
               tables.commands, tables.options, tables.values, tables.arguments, joined(keys)) +
           kFunction;
}

}  // namespace hilcam
