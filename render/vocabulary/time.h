#pragma once
// Instants: TAI nanoseconds inside the program, UTC text at its edges.

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace hilcam {

// Nanoseconds of International Atomic Time since 1970-01-01T00:00:00 TAI (the epoch of Linux's CLOCK_TAI).
// int64 covers the years 1678 to 2262.
struct TimeTai {
    std::int64_t ns = 0;

    friend constexpr auto operator<=>(TimeTai, TimeTai) = default;
    friend constexpr TimeTai operator+(TimeTai t, std::int64_t ns) { return {t.ns + ns}; }
    friend constexpr std::int64_t operator-(TimeTai a, TimeTai b) { return a.ns - b.ns; }
};

inline constexpr double kSecondsPerNs = 1e-9;
inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kDay_ns = 86'400 * kSecond_ns;
inline constexpr double kEpochJulianDay = 2440587.5;  // 1970-01-01T00:00:00
// Rounds to the nearest nanosecond.
inline std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

// Reads "2026-03-20T06:00:00[.fraction][Z]" as UTC; a blank may replace the T, and a zone ("+01:00") the Z.
// Throws InputError if the text has another form or the date is outside 1950-2200. Leap seconds come from
// ERFA's table (eraDat); its last value holds for later years. Before 1960 there was no UTC: UT replaces it
// and TAI - UT counts as 0, which is right to 3.2 s since 1950 (TT - UT was 29.07 s then: Morrison &
// Stephenson, J. Hist. Astron. 35, 2004).
TimeTai parse_utc(std::string_view text);
// Writes "2026-03-20T06:00:00.000Z".
std::string format_utc(TimeTai time);
// Writes the same with 1 to 9 decimals of a second.
std::string format_utc(TimeTai time, int decimals);

// Two-part Julian dates as ERFA takes them.
struct JulianDate {
    double day = 0;
    double fraction = 0;
};
JulianDate julian_tt(TimeTai time);
// UT1 - UTC is measured (earth_orientation.h). Using 0 instead turns the Earth by 14 arcsec at most.
JulianDate julian_ut1(TimeTai time, double ut1_minus_utc_s);

}  // namespace hilcam
