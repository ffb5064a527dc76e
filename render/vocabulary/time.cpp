#include "render/vocabulary/time.h"

#include <erfa.h>
#include <erfam.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time_system.h"

namespace hilcam {
namespace {

bool scan(std::string_view text, CalendarTime& t) {
    const std::string copy(text);
    char t_or_space = 0;
    int used = 0;
    if (std::sscanf(copy.c_str(), "%4d-%2d-%2d%c%2d:%2d:%n", &t.year, &t.month, &t.day, &t_or_space, &t.hour,
                    &t.minute, &used) != 6 ||
        used == 0 || (t_or_space != 'T' && t_or_space != ' '))
        return false;
    const char* rest = copy.c_str() + used;
    // strtod would also take "nan", "inf" and hexadecimals.
    if (*rest < '0' || *rest > '9') return false;
    char* end = nullptr;
    t.second = std::strtod(rest, &end);
    if (*end == 'Z') ++end;
    return *end == '\0' && copy.find_first_of("xXeEnN") == std::string::npos;
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
