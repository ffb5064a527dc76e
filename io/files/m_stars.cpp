#include "io/files/m_stars.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>

namespace hilcam {
namespace {

// V-Ic by subclass from M0 on, from the spectra of Pickles, PASP 110, 863 (1998)
// (tools/make_star_spectra.py). Supergiants continue from his K4 I by 0.15 mag a class.
// tools/star_catalogue/m_stars.py has the same numbers for the shipped catalogue.
using ByClass = std::array<double, 8>;
constexpr ByClass kGiants = {1.64, 1.75, 1.86, 2.08, 2.40, 2.80, 3.26, 3.88};
constexpr ByClass kSupergiants = {1.93, 2.08, 2.24, 2.40, 2.70, 3.00, 3.40, 3.90};
constexpr ByClass kDwarfs = {1.70, 1.86, 2.01, 2.43, 2.77, 3.14, 3.71, 3.71};  // to M6

// Removes blanks and these letters from the front.
void skip(std::string_view& text, std::string_view letters) {
    while (!text.empty() && (text.front() == ' ' || letters.find(text.front()) != std::string_view::npos))
        text.remove_prefix(1);
}

// Removes "2" or "2.5" from the front and returns it.
std::optional<double> take_subclass(std::string_view& text) {
    const auto digit = [&](std::size_t i) {
        return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    };
    if (!digit(0)) return {};
    double value = text[0] - '0';
    text.remove_prefix(1);
    if (text.size() > 1 && text[0] == '.' && digit(1)) {
        value += 0.1 * (text[1] - '0');
        text.remove_prefix(2);
    }
    return value;
}

const ByClass& colors_of(char prefix, std::string_view luminosity) {
    const std::size_t at = luminosity.find_first_of("IV");
    std::string_view roman = at == std::string_view::npos ? std::string_view{} : luminosity.substr(at);
    roman = roman.substr(0, std::min(roman.size(), roman.find_first_not_of("IV")));
    if (prefix == 'd' || roman == "V" || roman == "VI") return kDwarfs;
    if (prefix == 's' || roman == "I") return kSupergiants;
    return kGiants;
}

}  // namespace

std::optional<double> m_star_v_i(std::string_view type) {
    skip(type, "");
    char prefix = ' ';
    if (!type.empty() && (type.front() == 'g' || type.front() == 'd' || type.front() == 's')) {
        prefix = type.front();
        type.remove_prefix(1);
    }
    if (type.empty() || type.front() != 'M') return {};
    type.remove_prefix(1);
    const std::optional<double> first = take_subclass(type);
    if (!first) return {};
    // A range: "-M2", "/3".
    std::string_view rest = type;
    skip(rest, "");
    double last = *first;
    if (!rest.empty() && (rest.front() == '-' || rest.front() == '/')) {
        rest.remove_prefix(1);
        skip(rest, "M");
        if (const std::optional<double> second = take_subclass(rest)) last = *second, type = rest;
    }
    const ByClass& colors = colors_of(prefix, type);
    const double subclass = std::min(0.5 * (*first + last), static_cast<double>(colors.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(subclass), colors.size() - 2);
    const double share = subclass - static_cast<double>(below);
    return (1 - share) * colors[below] + share * colors[below + 1];
}

}  // namespace hilcam
