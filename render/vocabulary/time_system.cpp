#include "render/vocabulary/time_system.h"

#include <erfa.h>
#include <erfaextra.h>

#include <cmath>
#include <vector>

namespace hilcam {
namespace {

TimeTai from_julian(double day, double fraction) {
    const double days = day - kEpochJulianDay;
    return {static_cast<std::int64_t>(std::llround(days)) * kDay_ns +
            std::llround(((days - std::round(days)) + fraction) * static_cast<double>(kDay_ns))};
}

std::optional<TimeTai> from_utc(const CalendarTime& t) {
    // ERFA's UTC is a quasi Julian date whose day may have a leap second; only it may count those seconds.
    double utc1, utc2, tai1, tai2;
    const int status = eraDtf2d("UTC", t.year, t.month, t.day, t.hour, t.minute, t.second, &utc1, &utc2);
    if (status < 0 || status > 1 || eraUtctai(utc1, utc2, &tai1, &tai2) < 0) return {};
    return from_julian(tai1, tai2);
}

double tdb_minus_tt_s(TimeTai time) {
    const JulianDate tt = julian_tt(time);
    return eraDtdb(tt.day, tt.fraction, 0.0, 0.0, 0.0, 0.0);
}

}  // namespace

std::optional<TimeTai> from_calendar(const CalendarTime& t, TimeSystem system) {
    if (t.year < 1950 || t.year > 2200 || !std::isfinite(t.second)) return {};
    if (system == TimeSystem::kUtc) return from_utc(t);
    double day, mjd;
    if (eraCal2jd(t.year, t.month, t.day, &day, &mjd) != 0) return {};
    if (t.hour < 0 || t.hour > 23 || t.minute < 0 || t.minute > 59 || t.second < 0 || t.second >= 60)
        return {};
    // Nanoseconds in integers: a day in double precision resolves only 15 ns.
    const std::int64_t minutes_ns = (t.hour * 60 + t.minute) * 60'000'000'000LL;
    const TimeTai same{std::llround(day + mjd - kEpochJulianDay) * kDay_ns + minutes_ns + to_ns(t.second)};
    constexpr std::int64_t kTtMinusTai_ns = 32'184'000'000, kTaiMinusGps_ns = 19'000'000'000;
    switch (system) {
        case TimeSystem::kTai:
        case TimeSystem::kUtc:
            break;
        case TimeSystem::kTt:
            return same + -kTtMinusTai_ns;
        case TimeSystem::kGps:
            return same + kTaiMinusGps_ns;
        case TimeSystem::kTdb: {
            // TDB - TT changes by 3e-10 per second, so using the date as if it were TT is right to 1 ps.
            const TimeTai tt = same + -kTtMinusTai_ns;
            return tt + -to_ns(tdb_minus_tt_s(tt));
        }
    }
    return same;
}

std::optional<CalendarTime> calendar_of_day(int year, int day_of_year) {
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    int day = day_of_year;
    for (int month = 1; month <= 12 && day >= 1; ++month) {
        const int length = month == 2                                              ? (leap ? 29 : 28)
                           : month == 4 || month == 6 || month == 9 || month == 11 ? 30
                                                                                   : 31;
        if (day <= length) return CalendarTime{year, month, day, 0, 0, 0};
        day -= length;
    }
    return {};
}

void use_leap_seconds(std::span<const LeapSecond> table) {
    // ERFA keeps the pointer.
    static std::vector<eraLEAPSECOND> kept;
    eraSetLeapSeconds(nullptr, 0);
    if (table.empty()) return;
    // ERFA handles the years before the table itself: those to 1972, when the length of seconds varied.
    eraLEAPSECOND* own = nullptr;
    const int own_count = eraGetLeapSeconds(&own);
    kept.clear();
    for (int i = 0; i < own_count; ++i)
        if (own[i].iyear * 12 + own[i].month < table.front().year * 12 + table.front().month)
            kept.push_back(own[i]);
    for (const LeapSecond& leap : table) kept.push_back({leap.year, leap.month, leap.tai_minus_utc_s});
    eraSetLeapSeconds(kept.data(), static_cast<int>(kept.size()));
}

std::vector<LeapSecond> leap_seconds_in_use() {
    std::vector<LeapSecond> out;
    eraLEAPSECOND* table = nullptr;
    const int count = eraGetLeapSeconds(&table);
    // Before 1972 the length of seconds varied.
    for (int i = 0; i < count; ++i)
        if (table[i].iyear >= 1972) out.push_back({table[i].iyear, table[i].month, table[i].delat});
    return out;
}

}  // namespace hilcam
