#include "io/spice/ephemeris_time.h"

#include <cmath>

#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

// J2000's date and time read as TAI: 2000-01-01T12:00:00, 10957.5 days after TimeTai's epoch.
constexpr TimeTai kNoonTai{946'728'000 * kSecond_ns};

double periodic_s(const EphemerisTime& c, double seconds) {
    const double m = c.m0_rad + c.m1_rad_s * seconds;
    return c.k_s * std::sin(m + c.eb * std::sin(m));
}

}  // namespace

double EphemerisTime::et_s(TimeTai time) const {
    // Seconds and nanoseconds are kept apart, to lose no digits of either.
    const std::int64_t ns = time - kNoonTai;
    const double tai_s =
        static_cast<double>(ns / kSecond_ns) + static_cast<double>(ns % kSecond_ns) * kSecondsPerNs;
    const double tt_s = tai_s + delta_t_a_s;
    return tt_s + periodic_s(*this, tt_s);
}

TimeTai EphemerisTime::tai(double et_s) const {
    // int64 covers 1678 to 2262.
    constexpr double kReach_s = 8e9;
    if (!(et_s > -kReach_s)) et_s = -kReach_s;
    if (et_s > kReach_s) et_s = kReach_s;
    const double tai_s = tt_s(et_s) - delta_t_a_s;
    const double whole = std::floor(tai_s);
    return kNoonTai + (static_cast<std::int64_t>(whole) * kSecond_ns + std::llround((tai_s - whole) * 1e9));
}

// The periodic part changes by 1e-13 s over a time as long as itself.
double EphemerisTime::tt_s(double et_s) const { return et_s - periodic_s(*this, et_s); }

EphemerisTime ephemeris_time(const KernelPool& pool) {
    EphemerisTime out;
    if (const auto v = pool.number("DELTET/DELTA_T_A")) out.delta_t_a_s = *v;
    if (const auto v = pool.number("DELTET/K")) out.k_s = *v;
    if (const auto v = pool.number("DELTET/EB")) out.eb = *v;
    if (pool.find("DELTET/M")) {
        const auto m = pool.require_numbers("DELTET/M", 2, "a leap-second kernel");
        out.m0_rad = m[0], out.m1_rad_s = m[1];
    }
    // TDB is within 2 ms of TT, and TT - TAI is 32.184 s by definition.
    if (!(std::abs(out.delta_t_a_s - 32.184) < 1e-6) || !(std::abs(out.k_s) < 0.01) ||
        !(std::abs(out.eb) < 0.1) || !(std::abs(out.m0_rad) < 100) || !(std::abs(out.m1_rad_s) < 1e-3))
        throw InputError(
            "the leap-second kernel's DELTET constants are not those of TDB; accepted: as in naif0012.tls");
    return out;
}

std::vector<LeapSecond> leap_seconds_of(const KernelPool& pool) {
    const auto values = pool.numbers("DELTET/DELTA_AT");
    if (!values) return {};
    const std::string where = pool.find("DELTET/DELTA_AT")->where + ": DELTET/DELTA_AT";
    if (values->size() % 2 != 0) throw InputError(where + ": found an odd number of values; accepted: pairs");
    std::vector<LeapSecond> out;
    double before_s = -1e12;
    for (std::size_t i = 0; i < values->size(); i += 2) {
        const double offset_s = (*values)[i], date_s = (*values)[i + 1];
        // Noon to midnight, counted from 2000-01-01.
        const double day = date_s / kJulianDay_s + 0.5;
        const auto fail = [&] {
            throw InputError(where + ": pair " + std::to_string(i / 2 + 1) + ": found " + plain(offset_s) +
                             " and " + plain(date_s) +
                             " s; accepted: TAI - UTC and the first of a month, dates that rise");
        };
        if (!(date_s > before_s) || !(std::abs(offset_s) < 1000) || day != std::floor(day) ||
            !(std::abs(day) < 60000))
            fail();
        before_s = date_s;
        LeapSecond leap{0, 0, offset_s};
        double left = day;
        for (leap.year = 2000; left < 0; --leap.year) left += calendar_of_day(leap.year - 1, 366) ? 366 : 365;
        while (left >= (calendar_of_day(leap.year, 366) ? 366 : 365))
            left -= calendar_of_day(leap.year++, 366) ? 366 : 365;
        const auto date = calendar_of_day(leap.year, static_cast<int>(left) + 1);
        if (!date || date->day != 1) fail();
        leap.month = date->month;
        out.push_back(leap);
    }
    return out;
}

}  // namespace hilcam
