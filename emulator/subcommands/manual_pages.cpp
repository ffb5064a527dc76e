#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "emulator/subcommands/command_pages.h"

namespace hilcam {
namespace {

// Escapes what roff would interpret: a backslash, and a dot or quote at the begin of a line. A literal hyphen
// is "\-".
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool line_begins = out.empty() || out.back() == '\n';
        if (line_begins && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

std::string head_of(const OptionText& option) {
    if (option.is_positional) return "\\fI" + roff(upper(option.names.front())) + "\\fR";
    std::string names;
    for (const std::string& name : option.names)
        names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
    return names + (option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR");
}

std::string body_of(const OptionText& option) {
    std::string text = option.meaning;
    if (!option.accepted.empty()) text += (text.empty() ? "" : "; ") + ("accepted: " + option.accepted);
    if (option.is_positional && !option.words.empty()) text += "; accepted: " + option.value;
    if (!option.usual.empty()) text += " [" + option.usual + "]";
    if (option.is_required && !option.is_positional) text += " (required)";
    return text;
}

std::string synopsis(const std::string& words, const CommandText& command) {
    std::string line = "\\fB" + roff(words) + "\\fR";
    for (const OptionText& o : command.options)
        if (!o.is_positional && o.is_required) line += " " + head_of(o);
    line += " [\\fIOPTION\\fR]...";
    for (const OptionText& o : command.options)
        if (o.is_positional) line += o.is_required ? " " + head_of(o) : " [" + head_of(o) + "]";
    if (!command.commands.empty()) line += " \\fICOMMAND\\fR";
    return line;
}

std::string option_list(const CommandText& command) {
    std::string out;
    for (const bool positional : {true, false})
        for (const OptionText& o : command.options) {
            if (o.is_positional != positional) continue;
            const std::string body = roff(body_of(o));
            out += ".TP\n" + head_of(o) + "\n" + (body.empty() ? "\\&" : body) + "\n";
        }
    return out;
}

std::string header(const std::string& name, const std::string& meaning, const std::string& version) {
    // Without a date, so that two builds give the same bytes.
    return fmt::format(".TH {} 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", upper(roff(name)),
                       version, roff(name), roff(meaning));
}

// The last section of each page.
std::string see_also(const std::string& pages) {
    return ".SH SEE ALSO\n" + pages +
           "\n.PP\nEvery key of a scenario file: \\fBhilcam manual\\fR. Guides: share/doc/hilcam, in the "
           "prefix that has "
           "bin/hilcam.\n";
}

// Returns the examples of a command and its subcommands; empty: none.
std::string examples(const CommandText& command) {
    std::string lines;
    const auto add = [&](const CommandText& of) {
        for (const std::string& example : of.examples) lines += roff(example) + "\n";
    };
    add(command);
    for (const CommandText& below : command.commands) add(below);
    return lines.empty() ? "" : ".SH EXAMPLES\n.nf\n" + lines + ".fi\n";
}

constexpr const char* kEnds =
    ".SH EXIT STATUS\n0 done, 1 failed at run time, 2 wrong usage or configuration. Messages go to standard "
    "error, data to standard output.\n";

std::string subcommand_page(const CommandText& command, const std::string& version) {
    std::string out = header("hilcam-" + command.name, command.meaning, version);
    out += ".SH SYNOPSIS\n" + synopsis("hilcam " + command.name, command) + "\n";
    out += ".SH OPTIONS\n" + option_list(command);
    if (!command.commands.empty()) out += ".SH COMMANDS\n";
    for (const CommandText& below : command.commands)
        out += ".SS " + roff(below.name) + "\n" +
               synopsis("hilcam " + command.name + " " + below.name, below) + "\n.PP\n" +
               roff(below.meaning) + "\n" + option_list(below);
    return out + examples(command) + kEnds + see_also(".BR hilcam (1)");
}

std::string main_page(const CommandText& program, const std::string& version) {
    std::string out = header("hilcam", "a spacecraft's camera for the test bench", version);
    out += ".SH SYNOPSIS\n" + synopsis("hilcam", program) + "\n";
    out +=
        ".SH DESCRIPTION\nhilcam stands in for a spacecraft's visible camera. It takes poses, traces what "
        "the "
        "camera would see, puts the light through a model of optics, detector and electronics, and publishes "
        "the frames as a GigE Vision camera, a V4L2 device, a USB camera or files.\n.PP\nA "
        "\\fICONFIG\\fR is the path of a scenario (YAML), or the name of a shipped one, as in \\fBhilcam run "
        "geo_inspection\\fR.\n";
    out += ".SH COMMANDS\n";
    for (const CommandText& command : program.commands)
        out += ".TP\n.BR hilcam\\-" + roff(command.name) + " (1)\n" + roff(command.meaning) + "\n";
    out += ".SH OPTIONS\n" + option_list(program);
    CommandText alone = program;  // the examples of subcommands are in their own pages
    alone.commands.clear();
    out += examples(alone) + kEnds;
    out +=
        ".SH ENVIRONMENT\n.TP\nHILCAM_CACHE\nfolder of what takes long to make; else $XDG_CACHE_HOME/hilcam, "
        "else ~/.cache/hilcam\n.TP\nHILCAM_CACHE_MB\nmegabytes that it may have (4096); 0: what is there is "
        "used, nothing is written\n.TP\nHILCAM_PROGRESS_S\nseconds between two lines that say how far long "
        "work is, where standard error is no terminal [30]; 0: none\n.TP\nNOTIFY_SOCKET\nnotified when the "
        "camera is ready and when it stops, as by .BR sd_notify (3)\n";
    std::string pages;
    for (const CommandText& command : program.commands)
        pages += (pages.empty() ? "" : ",\n") + (".BR hilcam\\-" + roff(command.name) + " (1)");
    return out + see_also(pages);
}

}  // namespace

std::vector<NamedText> manual_pages(const CommandText& program, const std::string& version) {
    std::vector<NamedText> pages = {{"hilcam.1", main_page(program, version)}};
    for (const CommandText& command : program.commands)
        pages.push_back({"hilcam-" + command.name + ".1", subcommand_page(command, version)});
    return pages;
}

}  // namespace hilcam
