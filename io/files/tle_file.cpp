#include "io/files/tle_file.h"

#include <algorithm>
#include <cmath>

#include "io/files/text_lines.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kLineColumns = 69;
// Owners give names longer than the format's 24 characters.
constexpr std::size_t kLongestTitle = 200;
constexpr double kMinutesPerDay = 1440;

// Columns are numbered from 1, as in the format's description.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
    return trimmed(line.substr(first - 1, last - first + 1));
}

// The last digit of a sum: digits count as they are, minus signs as 1, all else as 0.
char checksum_of(std::string_view line) {
    int sum = 0;
    for (const char c : line.substr(0, kLineColumns - 1)) {
        if (c >= '0' && c <= '9') sum += c - '0';
        if (c == '-') ++sum;
    }
    return static_cast<char>('0' + sum % 10);
}

// Returns digits as a fraction, after an assumed decimal point.
std::optional<double> fraction_of(std::string_view digits) {
    std::string text = ".";
    text += digits;
    return number_of(text);
}

// One of the two lines, with its error messages.
struct Line {
    const TextLines& lines;
    std::string_view text;
    int number;

    double value(std::size_t first, std::size_t last, const char* name, double least, double most) const {
        const std::string_view digits = columns(text, first, last);
        const auto found = number_of(digits);
        if (!found || *found < least || *found > most) refuse(digits, first, last, name);
        return *found;
    }
    // Returns a number with an assumed decimal point: "-12345-3" is -0.12345e-3.
    double assumed_point(std::size_t first, std::size_t last, const char* name) const {
        const std::string_view all = columns(text, first, last);
        std::string_view digits = all;
        const bool negative = digits.starts_with('-');
        if (negative || digits.starts_with('+')) digits.remove_prefix(1);
        const std::size_t sign = digits.find_last_of("+-");
        if (sign == std::string_view::npos) refuse(all, first, last, name);
        const auto mantissa = fraction_of(digits.substr(0, sign));
        const auto exponent = number_of(digits.substr(sign + 1));
        if (!mantissa || !exponent || *mantissa < 0 || *exponent < 0 || *exponent > 9)
            refuse(all, first, last, name);
        const double magnitude = *mantissa * std::pow(10, digits[sign] == '-' ? -*exponent : *exponent);
        return negative ? -magnitude : magnitude;
    }
    [[noreturn]] void refuse(std::string_view found, std::size_t first, std::size_t last,
                             const char* name) const {
        lines.refuse(
            found, std::string(name) + " in columns " + std::to_string(first) + " to " + std::to_string(last),
            number);
    }
};

void check_line(const TextLines& lines, std::string_view line, char number, TleChecksum checksum) {
    const bool ignored = checksum == TleChecksum::kIgnore;
    const std::size_t least = ignored ? kLineColumns - 1 : kLineColumns;
    if (line.size() < least || (line.size() > kLineColumns && !trimmed(line.substr(kLineColumns)).empty()))
        lines.refuse(line, std::string("line ") + number + " of an element set, 69 columns" +
                               (ignored ? " (or 68, without the checksum)" : "") + "; it has " +
                               std::to_string(line.size()) +
                               (!ignored && line.size() == kLineColumns - 1
                                    ? " (checksum: ignore takes lines without their checksum)"
                                    : ""));
    if (line[0] != number || line[1] != ' ')
        lines.refuse(line.substr(0, 2), std::string("'") + number + " ' before an element set's line");
    if (ignored) return;
    const char expected = checksum_of(line), found = line[kLineColumns - 1];
    if (found != expected)
        lines.refuse(line.substr(kLineColumns - 1, 1),
                     std::string("checksum ") + expected + " in column 69 (or checksum: ignore)");
}

void read_epoch(const Line& line, ElementSet& tle) {
    const int two_digits = static_cast<int>(line.value(19, 20, "the epoch's year", 0, 99));
    const double day = line.value(21, 32, "the epoch's day of the year", 1, 367);
    const int year = two_digits < 57 ? 2000 + two_digits : 1900 + two_digits;
    const double whole = std::floor(day);
    const std::optional<CalendarTime> date = calendar_of_day(year, static_cast<int>(whole));
    if (!date) line.refuse(columns(line.text, 19, 32), 19, 32, "an epoch: a day of its year");
    // Days of 86400 s after midnight UTC of the epoch's own date.
    tle.epoch = *from_calendar(*date, TimeSystem::kUtc) + std::llround((day - whole) * 86400e9);
    tle.epoch_days_1950 = days_since_1950(year, 1, 1, 0) - 1 + day;
}

// Refuses a line of a set with blanks outside ASCII. Otherwise it would pass for a satellite's name, which
// may have any character.
void refuse_odd_blanks(const TextLines& lines, std::string_view line) {
    const std::string odd = odd_blank_in(line);
    if (odd.empty() || line.size() < kLineColumns - 1 || (line[0] != '1' && line[0] != '2')) return;
    lines.fail("the line has " + odd + "; accepted: a line of an element set with plain blanks");
}

ElementSet read_set(const TextLines& lines, const Line& one, const Line& two) {
    ElementSet tle;
    tle.where = lines.name() + ":" + std::to_string(one.number);
    tle.satellite = columns(one.text, 3, 7);
    if (tle.satellite.empty()) one.refuse("", 3, 7, "a satellite's number");
    if (const std::string_view other = columns(two.text, 3, 7);
        other != tle.satellite &&
        (!catalogue_number(other) || catalogue_number(other) != catalogue_number(tle.satellite)))
        lines.refuse(other, "satellite " + tle.satellite + ", as on the line before", two.number);
    read_epoch(one, tle);
    // In a set of another theory, columns 45 to 61 have other quantities.
    tle.refusal = refusal_of_ephemeris_type(columns(one.text, 63, 63));
    if (!tle.refusal.empty()) return tle;
    tle.bstar_per_er = one.assumed_point(54, 61, "drag (B*)");
    tle.inclination_rad = two.value(9, 16, "the inclination, 0 to 180 deg,", 0, 180) * kDegree_rad;
    tle.node_rad = two.value(18, 25, "the node, 0 to 360 deg,", 0, 360) * kDegree_rad;
    const std::string_view digits = columns(two.text, 27, 33);
    const auto eccentricity = fraction_of(digits);
    if (!eccentricity || digits.size() != 7 || *eccentricity < 0)
        two.refuse(digits, 27, 33, "seven digits of the eccentricity");
    tle.eccentricity = *eccentricity;
    tle.perigee_rad = two.value(35, 42, "the argument of perigee, 0 to 360 deg,", 0, 360) * kDegree_rad;
    tle.mean_anomaly_rad = two.value(44, 51, "the mean anomaly, 0 to 360 deg,", 0, 360) * kDegree_rad;
    const double turns_day = two.value(53, 63, "the mean motion, above 0 to 20 turns a day,", 1e-8, 20);
    tle.mean_motion_rad_min = turns_day * kTurn_rad / kMinutesPerDay;
    return tle;
}

// True for a line with a satellite's name. A name that begins like a line of a set ("1 KUNS-PF") is
// recognised by the whole line 1 that follows.
bool is_name(const TextLines& lines, std::string_view line) {
    if (!line.starts_with("1 ") && !line.starts_with("2 ")) return true;
    TextLines ahead = lines;
    std::string_view next;
    return line.size() < kLineColumns - 1 && ahead.next(next) && next.starts_with("1 ") &&
           next.size() >= kLineColumns - 1;
}

}  // namespace

std::vector<ElementSet> read_tles(std::string_view text, const std::string& name, TleChecksum checksum) {
    TextLines lines(text, name);
    std::vector<ElementSet> sets;
    std::string title;
    std::string_view line;
    while (lines.next(line)) {
        if (trimmed(line).empty() || line.starts_with('#')) continue;
        refuse_odd_blanks(lines, line);
        if (is_name(lines, line)) {
            title = trimmed(line.starts_with("0 ") ? line.substr(2) : line);
            if (title.size() > kLongestTitle)
                lines.refuse(line, "an element set, or a satellite's name before it");
            continue;
        }
        if (line.starts_with("2 ")) lines.refuse(line, "line 1 of an element set before its line 2");
        check_line(lines, line, '1', checksum);
        const Line one{lines, line, lines.number()};
        std::string_view next;
        if (!lines.next(next)) lines.fail("the file ends; accepted: line 2 of the element set");
        refuse_odd_blanks(lines, next);
        check_line(lines, next, '2', checksum);
        sets.push_back(read_set(lines, one, {lines, next, lines.number()}));
        sets.back().name = title;
        title.clear();
    }
    if (sets.empty()) throw InputError(name + ": holds no element set; accepted: lines '1 ...' and '2 ...'");
    return sets;
}

}  // namespace hilcam
