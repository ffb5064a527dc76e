#pragma once
// Calendar dates in the time systems that ephemerides come in, and the table of leap seconds.

#include <optional>
#include <span>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

// GPS = TAI - 19 s, TT = TAI + 32.184 s (both exact); TDB by ERFA's eraDtdb for the geocentre (2 ms about TT,
// good to some us); UTC by the table of leap seconds.
enum class TimeSystem { kUtc, kTai, kTt, kGps, kTdb };

// Gregorian. A second of 60 is one of UTC's leap seconds.
struct CalendarTime {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0;
};
// Midnight of a day of a year, counted from 1. Nothing when the year has no such day.
std::optional<CalendarTime> calendar_of_day(int year, int day_of_year);
// Nothing for what is no date of the system, or lies outside 1950-2200. Any thread.
std::optional<TimeTai> from_calendar(const CalendarTime& calendar, TimeSystem system);

// TAI - UTC from the first of a month on.
struct LeapSecond {
    int year = 0, month = 0;
    double tai_minus_utc_s = 0;
};
// Replaces ERFA's table, for the whole program: before any other thread asks for a time. Empty: ERFA's own.
void use_leap_seconds(std::span<const LeapSecond> table);
// The table in use from 1972 on, which is ERFA's own until another one takes its place.
std::vector<LeapSecond> leap_seconds_in_use();

}  // namespace hilcam
