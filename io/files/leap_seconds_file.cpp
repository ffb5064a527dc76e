#include "io/files/leap_seconds_file.h"

#include <charconv>
#include <cstdint>

#include "io/files/text_lines.h"
#include "io/system/input_file.h"

namespace hilcam {
namespace {

constexpr std::uintmax_t kMaxListBytes = 1u << 20;
constexpr std::int64_t kSecondsPerDay = 86400;
// Seconds from NTP's epoch, 1900-01-01, to 1970-01-01 (RFC 5905).
constexpr std::int64_t kNtpToUnix_s = 2208988800;
constexpr std::int64_t kLatest_s = 300 * 366 * kSecondsPerDay;

std::optional<std::int64_t> seconds_of(std::string_view text) {
    const auto value = parsed_as<std::int64_t>(text);
    return value && *value >= 0 && *value <= kLatest_s ? value : std::nullopt;
}

// Returns the date of a day, counted from 1900-01-01.
CalendarTime date_of(std::int64_t day) {
    for (int year = 1900;; ++year) {
        const int length = calendar_of_day(year, 366) ? 366 : 365;
        if (day < length) return *calendar_of_day(year, static_cast<int>(day) + 1);
        day -= length;
    }
}

LeapSecond leap_of(const TextLines& lines, std::string_view line) {
    const std::string_view data = trimmed(line.substr(0, line.find('#')));
    const std::size_t gap = data.find_first_of(" \t");
    const auto seconds = seconds_of(data.substr(0, gap));
    const auto offset =
        gap == std::string_view::npos ? std::nullopt : parsed_as<int>(trimmed(data.substr(gap)));
    if (!seconds || !offset || *offset < 10 || *offset > 1000)
        lines.refuse(data, "seconds since 1900 and TAI - UTC, 10 s or more");
    const CalendarTime date = date_of(*seconds / kSecondsPerDay);
    if (*seconds % kSecondsPerDay != 0 || date.day != 1 || date.year < 1972)
        lines.refuse(data, "seconds since 1900 to the first of a month, from 1972 on");
    return {date.year, date.month, static_cast<double>(*offset)};
}

}  // namespace

LeapSecondsFile read_leap_seconds(std::string_view text, const std::string& name) {
    TextLines lines(text, name);
    LeapSecondsFile out;
    std::optional<std::int64_t> expires_s;
    for (std::string_view line; lines.next(line);) {
        if (line.starts_with("#@")) {
            expires_s = seconds_of(trimmed(line.substr(2)));
            if (!expires_s) lines.refuse(line, "#@ and the seconds since 1900 when the file expires");
        }
        if (line.starts_with('#') || trimmed(line).empty()) continue;
        const LeapSecond leap = leap_of(lines, line);
        if (!out.table.empty()) {
            const LeapSecond& before = out.table.back();
            if (leap.year * 12 + leap.month <= before.year * 12 + before.month)
                lines.refuse(line, "dates that rise from line to line");
        }
        out.table.push_back(leap);
    }
    if (out.table.empty() || !expires_s)
        throw InputError(name + ": has no " + (out.table.empty() ? "leap second" : "date of expiry (#@)") +
                         "; accepted: the IERS's leap-seconds.list");
    const auto offset_s = static_cast<std::int64_t>(out.table.back().tai_minus_utc_s);
    out.expires = {(*expires_s - kNtpToUnix_s + offset_s) * 1'000'000'000};
    return out;
}

LeapSecondsFile load_leap_seconds(const std::filesystem::path& file) {
    return read_leap_seconds(read_input_file(file, {kMaxListBytes, "the IERS's leap-seconds.list"}),
                             file.string());
}

}  // namespace hilcam
