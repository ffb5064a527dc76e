#pragma once
// Parses a text that is a number and nothing else: no blank, no unit, nothing after it. Any thread.

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace hilcam {

// Returns the number; nothing when the text is not one or when it is out of range. A floating-point number
// may be infinite or NaN.
template <class Number>
std::optional<Number> parsed_as(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

// Returns a finite number, with an optional plus sign.
inline std::optional<double> number_of(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto value = parsed_as<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

// Returns the same, and accepts a Fortran exponent with D: "1.5D+03".
inline std::optional<double> fortran_number_of(std::string_view text) {
    const std::size_t at = text.find_first_of("Dd");
    if (at == std::string_view::npos) return number_of(text);
    std::string plain(text.substr(0, 64));
    if (plain.size() < text.size()) return {};
    plain[at] = 'e';
    return number_of(plain);
}

}  // namespace hilcam
