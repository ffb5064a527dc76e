#pragma once
// Calendar dates in the time systems that ephemerides use, and the table of leap seconds.

#include <optional>
#include <span>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

// GPS = TAI - 19 s and TT = TAI + 32.184 s, both exact. TDB by ERFA's eraDtdb at the geocentre (within 2 ms
// of TT, good to some us). UTC by the table of leap seconds.
enum class TimeSystem { kUtc, kTai, kTt, kGps, kTdb };

// A Gregorian date and time. A second of 60 is a leap second of UTC.
struct CalendarTime {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0;
    double second = 0;
};
// Returns midnight of a day of the year, counted from 1; nothing if the year has no such day.
std::optional<CalendarTime> calendar_of_day(int year, int day_of_year);
// Returns nothing if the system has no such date, or if it is outside 1950-2200. Any thread.
std::optional<TimeTai> from_calendar(const CalendarTime& calendar, TimeSystem system);

// TAI - UTC from the first day of a month on.
struct LeapSecond {
    int year = 0, month = 0;
    double tai_minus_utc_s = 0;
};
// Replaces ERFA's table for the whole program; call it before any other thread asks for a time. Empty: ERFA's
// own.
void use_leap_seconds(std::span<const LeapSecond> table);
// Returns the table in use, from 1972 on: ERFA's own unless use_leap_seconds() replaced it.
std::vector<LeapSecond> leap_seconds_in_use();

}  // namespace hilcam
