#include "emulator/send/command_examples.h"

#include <sstream>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::string_view kExamplesTitle = "Examples:";

}  // namespace

void set_examples(CLI::App* command, const std::vector<std::string_view>& lines) {
    std::string text(kExamplesTitle);
    for (const std::string_view line : lines) {
        HILCAM_CHECK(line.size() <= 76);
        text += "\n  " + std::string(line);
    }
    command->footer(text);
}

std::vector<std::string> examples_of(const CLI::App& command) {
    std::istringstream footer(command.get_footer());
    std::vector<std::string> out;
    std::string line;
    if (!std::getline(footer, line) || line != kExamplesTitle) return out;
    while (std::getline(footer, line)) out.push_back(line.substr(line.find_first_not_of(' ')));
    return out;
}

}  // namespace hilcam
