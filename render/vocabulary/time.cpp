#include "render/vocabulary/time.h"

#include <erfa.h>
#include <erfam.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {
namespace {

// Reads a zone as in ISO 8601 and YAML: Z, or +hh:mm, +hhmm or +hh, with - for zones in the west, after
// optional blanks.
bool scan_zone(const char* rest, int& ahead_min) {
    while (*rest == ' ') ++rest;
    if (*rest == '\0') return true;
    if (*rest == 'Z') return rest[1] == '\0';
    if (*rest != '+' && *rest != '-') return false;
    const int sign = *rest++ == '-' ? -1 : 1;
    std::string digits;
    for (; *rest != '\0'; ++rest) {
        if (*rest == ':' && digits.size() == 2) continue;
        if (*rest < '0' || *rest > '9') return false;
        digits += *rest;
    }
    if (digits.size() != 2 && digits.size() != 4) return false;
    const int number = std::atoi(digits.c_str());
    const int hours = digits.size() == 4 ? number / 100 : number,
              minutes = digits.size() == 4 ? number % 100 : 0;
    ahead_min = sign * (60 * hours + minutes);
    return hours < 24 && minutes < 60;
}

// Converts local time to UTC. Leap seconds happen at the same instant in all zones, at the end of a minute.
bool set_back(CalendarTime& t, int ahead_min) {
    if (ahead_min == 0) return true;
    double day0 = 0, day = 0, fraction = 0;
    if (t.hour < 0 || t.hour > 23 || t.minute < 0 || t.minute > 59 ||
        eraCal2jd(t.year, t.month, t.day, &day0, &day) != 0)
        return false;
    constexpr int kDay_min = 24 * 60;
    const int minute = 60 * t.hour + t.minute - ahead_min;
    const int days = minute < 0 ? -1 : minute >= kDay_min ? 1 : 0;
    t.hour = (minute - days * kDay_min) / 60, t.minute = (minute - days * kDay_min) % 60;
    return eraJd2cal(day0, day + days, &t.year, &t.month, &t.day, &fraction) == 0;
}

bool scan(std::string_view text, CalendarTime& t) {
    const std::string copy(text);
    char t_or_space = 0;
    int used = 0;
    if (std::sscanf(copy.c_str(), "%4d-%2d-%2d%c%2d:%2d:%n", &t.year, &t.month, &t.day, &t_or_space, &t.hour,
                    &t.minute, &used) != 6 ||
        used == 0 || (t_or_space != 'T' && t_or_space != ' '))
        return false;
    const char* rest = copy.c_str() + used;
    // strtod would also accept "nan", "inf" and hexadecimals.
    if (*rest < '0' || *rest > '9' || copy.find_first_of("xXeEnN") != std::string::npos) return false;
    char* end = nullptr;
    t.second = std::strtod(rest, &end);
    int ahead_min = 0;
    return scan_zone(end, ahead_min) && set_back(t, ahead_min);
}

}  // namespace

TimeTai parse_utc(std::string_view text) {
    const auto refuse = [&](const char* why) {
        throw InputError("time " + in_quotes(text) + " " + why +
                         "; accepted: UTC as 2026-03-20T06:00:00.000Z, years 1950 to 2200");
    };
    CalendarTime t;
    if (!scan(text, t)) refuse("is not a date and time");
    if (t.year < 1950 || t.year > 2200) refuse("is out of range");
    const std::optional<TimeTai> time = from_calendar(t, TimeSystem::kUtc);
    if (!time) refuse("does not exist in UTC");
    return *time;
}

std::string format_utc(TimeTai time, int decimals) {
    const JulianDate tt = julian_tt(time);
    double tai1, tai2, utc1, utc2;
    int year, month, day, clock[4];
    if (eraTttai(tt.day, tt.fraction, &tai1, &tai2) < 0 || eraTaiutc(tai1, tai2, &utc1, &utc2) < 0 ||
        eraD2dtf("UTC", decimals, utc1, utc2, &year, &month, &day, clock) < 0)
        return "(no UTC date)";
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d.%0*dZ", year, month, day, clock[0],
                  clock[1], clock[2], decimals, clock[3]);
    return text.data();
}

std::string format_utc(TimeTai time) { return format_utc(time, 3); }

JulianDate julian_tt(TimeTai time) {
    // TT = TAI + 32.184 s, exact by definition.
    constexpr std::int64_t kTtMinusTai_ns = 32'184'000'000;
    const std::int64_t ns = time.ns + kTtMinusTai_ns;
    std::int64_t days = ns / kDay_ns;
    if (ns % kDay_ns < 0) --days;
    return {kEpochJulianDay + static_cast<double>(days),
            static_cast<double>(ns - days * kDay_ns) / static_cast<double>(kDay_ns)};
}

JulianDate julian_ut1(TimeTai time, double ut1_minus_utc_s) {
    const JulianDate tt = julian_tt(time);
    double tai1, tai2, utc1, utc2, ut11, ut12;
    eraTttai(tt.day, tt.fraction, &tai1, &tai2);
    eraTaiutc(tai1, tai2, &utc1, &utc2);
    eraUtcut1(utc1, utc2, ut1_minus_utc_s, &ut11, &ut12);
    return {ut11, ut12};
}

}  // namespace hilcam
