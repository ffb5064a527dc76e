// Dates in text kernels.

#include <array>
#include <cctype>

#include "io/spice/text_kernel.h"
#include "io/system/text_number.h"

namespace hilcam {
namespace {

constexpr std::array<std::string_view, 12> kMonths = {"JAN", "FEB", "MAR", "APR", "MAY", "JUN",
                                                      "JUL", "AUG", "SEP", "OCT", "NOV", "DEC"};

// Days from 2000-01-01 in the Gregorian calendar (Fliegel & Van Flandern, Comm. ACM 11, 1968, 657).
long days_from_2000(long year, long month, long day) {
    const long a = (month - 14) / 12;
    return day - 32075 + 1461 * (year + 4800 + a) / 4 + 367 * (month - 2 - a * 12) / 12 -
           3 * ((year + 4900 + a) / 100) / 4 - 2451545;
}

struct Part {
    std::string_view text;
    std::optional<double> number;
    int month = 0;  // month of that name; 0: it is none
};

int month_of(std::string_view text) {
    std::string upper;
    for (const char c : text) upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    constexpr std::array<std::string_view, 12> kNames = {"JANUARY",   "FEBRUARY", "MARCH",    "APRIL",
                                                         "MAY",       "JUNE",     "JULY",     "AUGUST",
                                                         "SEPTEMBER", "OCTOBER",  "NOVEMBER", "DECEMBER"};
    for (std::size_t i = 0; i < kMonths.size(); ++i)
        if (upper.starts_with(kMonths[i]) && kNames[i].starts_with(upper)) return static_cast<int>(i) + 1;
    return 0;
}

bool is_separator(char c) { return c == '-' || c == '/' || c == ':' || c == ',' || c == '_' || c == ' '; }

}  // namespace

std::optional<double> kernel_date_s(std::string_view text) {
    std::array<Part, 6> parts;
    std::size_t count = 0;
    for (std::size_t i = 0; i < text.size();) {
        const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
        // A T between digits separates date and time.
        if (is_separator(text[i]) || ((text[i] == 'T' || text[i] == 't') && i > 0 && digit(text[i - 1]))) {
            ++i;
            continue;
        }
        std::size_t end = i;
        const bool number = digit(text[i]);
        while (end < text.size() && !is_separator(text[end]) &&
               (number ? digit(text[end]) || text[end] == '.' : true))
            ++end;
        if (count == parts.size() || end == i) return {};
        Part& part = parts[count++];
        part.text = text.substr(i, end - i);
        part.number = number ? number_of(part.text) : std::nullopt;
        part.month = number ? 0 : month_of(part.text);
        if (!part.number && part.month == 0) return {};
        i = end;
    }
    if (count < 2) return {};
    // Decides which of the first parts are year, month and day.
    const auto whole = [&](std::size_t i) {
        return i < count && parts[i].number && *parts[i].number == std::floor(*parts[i].number) &&
                       *parts[i].number < 1e5
                   ? static_cast<long>(*parts[i].number)
                   : -1;
    };
    long year = -1, month = 0, day = -1;
    std::size_t used = 3;
    std::size_t name = count;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, count); ++i)
        if (parts[i].month) name = i;
    const auto is_year = [&](std::size_t i) { return whole(i) > 31; };
    if (name < count) {
        const std::size_t a = name == 0 ? 1 : 0, b = name == 2 ? 1 : 2;
        month = parts[name].month;
        year = is_year(a) ? whole(a) : whole(b), day = is_year(a) ? whole(b) : whole(a);
    } else if (is_year(0) && (count == 2 || parts[1].text.size() == 3)) {
        year = whole(0), month = 1, day = whole(1), used = 2;
    } else if (is_year(0)) {
        year = whole(0), month = whole(1), day = whole(2);
    } else {
        month = whole(0), day = whole(1), year = whole(2);
    }
    if (year < 1000 || year > 9999 || month < 1 || month > 12 || day < 1 || day > (used == 2 ? 366 : 31))
        return {};
    double seconds = 0;
    constexpr std::array<double, 3> kUnits_s = {3600, 60, 1};
    for (std::size_t i = used; i < count; ++i) {
        if (i - used >= kUnits_s.size() || !parts[i].number) return {};
        seconds += kUnits_s[i - used] * *parts[i].number;
    }
    return kJulianDay_s * static_cast<double>(days_from_2000(year, month, day)) - kJulianDay_s / 2 + seconds;
}

}  // namespace hilcam
