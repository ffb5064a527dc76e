#include "emulator/campaign/number_draw.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace hilcam {

NumberDraw::Kind NumberDraw::kind() const {
    if (has_value) return Kind::kValue;
    if (has_uniform) return Kind::kUniform;
    if (has_log_uniform) return Kind::kLogUniform;
    if (has_normal) return Kind::kNormal;
    if (has_choice) return Kind::kChoice;
    return Kind::kNone;
}

Fields fields(NumberDraw& d, Range range) {
    return {
        optional(number("value", d.value, 1, range, "the same number in every case"), d.has_value),
        optional(numbers("uniform", d.uniform, 1, range, {2, 2}, "limits of a uniformly distributed number"),
                 d.has_uniform),
        optional(numbers("log_uniform", d.log_uniform, 1, range, {2, 2},
                         "limits, above 0, of a log-uniformly distributed number"),
                 d.has_log_uniform),
        optional(numbers("normal", d.normal, 1, {}, {2, 2},
                         "mean and standard deviation of a normal number, cut at 6 deviations"),
                 d.has_normal),
        optional(numbers("choice", d.choice, 1, range, {1, 100000}, "numbers of equal probability"),
                 d.has_choice),
    };
}

void validate(const NumberDraw& d) {
    const int count = d.has_value + d.has_uniform + d.has_log_uniform + d.has_normal + d.has_choice;
    if (count != 1)
        throw InputError("found " + std::to_string(count) +
                         " distributions; accepted: one of value, uniform, log_uniform, normal, choice");
    const auto rising = [](const char* key, const std::vector<double>& ends) {
        if (!(ends[0] <= ends[1]))
            throw refused_key(key, exact_number(ends[0]) + " before " + exact_number(ends[1]),
                              "the least, then the most");
    };
    if (d.has_uniform) rising("uniform", d.uniform);
    if (d.has_log_uniform) rising("log_uniform", d.log_uniform);
    if (d.has_log_uniform && !(d.log_uniform[0] > 0))
        throw refused_key("log_uniform", exact_number(d.log_uniform[0]), "numbers above 0");
    if (d.has_normal && !(d.normal[1] >= 0))
        throw refused_key("normal", "a standard deviation of " + exact_number(d.normal[1]), "0 or more");
}

double normal_quantile(double place) {
    // Uses the symmetry of the distribution for the upper half.
    if (place > 0.5) return -normal_quantile(1 - place);
    double low = -40, high = 0;
    for (int step = 0; step < 80; ++step) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < place ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double number_at(const NumberDraw& d, double place) {
    const auto between = [place](double least, double most) {
        return std::clamp(least + place * (most - least), least, most);
    };
    switch (d.kind()) {
        case NumberDraw::Kind::kNone:
        case NumberDraw::Kind::kValue:
            break;
        case NumberDraw::Kind::kUniform:
            return between(d.uniform[0], d.uniform[1]);
        case NumberDraw::Kind::kLogUniform:
            return std::clamp(std::exp(between(std::log(d.log_uniform[0]), std::log(d.log_uniform[1]))),
                              d.log_uniform[0], d.log_uniform[1]);
        case NumberDraw::Kind::kNormal: {
            constexpr double kCut = 6;
            return d.normal[0] + d.normal[1] * std::clamp(normal_quantile(place), -kCut, kCut);
        }
        case NumberDraw::Kind::kChoice:
            return d.choice[std::min(static_cast<std::size_t>(place * static_cast<double>(d.choice.size())),
                                     d.choice.size() - 1)];
    }
    return d.value;
}

std::string exact_number(double value) {
    std::array<char, 32> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end};
}

}  // namespace hilcam
