#include "emulator/send/number_options.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <system_error>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// A validator returns an empty text, or what is wrong with the text.
template <class Whole>
std::string whole_number(std::string& text, const char* accepted) {
    Whole value{};
    const char* const last = text.data() + text.size();
    const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || end != last)
        return "found " + in_quotes(text) + "; accepted: a whole number" + accepted;
    text = std::to_string(value);  // without leading zeros, which CLI11 would read as octal
    return {};
}

std::string finite_number(std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool whole_text = !text.empty() && end == text.c_str() + text.size();
    return whole_text && std::isfinite(value) ? std::string()
                                              : "found " + in_quotes(text) + "; accepted: a number";
}

// CLI11 begins the type name with the kind of value: "UINT", "INT:INT in [1 - 9]", "[FLOAT,FLOAT,FLOAT]".
void read_strictly(CLI::Option& option) {
    const std::string named = option.get_type_name();
    const std::string kind = named.starts_with('[') ? named.substr(1) : named;
    const auto add = [&](auto check) {
        option.transform(CLI::Validator([check](std::string& text) { return check(text); }, ""));
    };
    if (kind.starts_with("UINT"))
        add([](std::string& text) { return whole_number<std::uint64_t>(text, ", 0 or more"); });
    else if (kind.starts_with("INT"))
        add([](std::string& text) { return whole_number<std::int64_t>(text, ""); });
    else if (kind.starts_with("FLOAT"))
        add(finite_number);
}

}  // namespace

void read_numbers_strictly(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) read_strictly(*option);
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        read_numbers_strictly(*command);
}

}  // namespace hilcam
