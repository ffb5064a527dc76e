#include <gtest/gtest.h>

#include "render/vocabulary/check.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

TEST(Time, UtcTextComesBackAndLeapSecondsCount) {
    EXPECT_EQ(format_utc(parse_utc("2026-03-20T14:46:00.250Z")), "2026-03-20T14:46:00.250Z");
    // TAI - UTC was 10 s in 1972 and is 37 s since 2017 (IERS Bulletin C).
    EXPECT_EQ(parse_utc("1972-01-01T00:00:00Z").ns, (730 * 86400 + 10) * 1'000'000'000LL);
    EXPECT_EQ(parse_utc("2017-01-01T00:00:00Z") - parse_utc("2016-12-31T23:59:59Z"), 2'000'000'000LL);
}

// As YAML's writers have an instant: PyYAML puts a blank for the T, and the zone's hours and minutes.
TEST(Time, ZonesAreSetBackToUtc) {
    const TimeTai noon = parse_utc("2026-03-20T14:00:00Z");
    for (const char* text :
         {"2026-03-20 14:00:00+00:00", "2026-03-20 14:00:00", "2026-03-20T14:00:00-00:00",
          "2026-03-20 15:30:00+01:30", "2026-03-20T15:30:00+0130", "2026-03-20 09:00:00 -05",
          "2026-03-20T14:00:00.000 Z", "2026-03-21 02:00:00+12:00", "2026-03-20 14:00:00.000000+00:00"})
        EXPECT_EQ(parse_utc(text), noon) << text;
    EXPECT_EQ(parse_utc("2026-01-01 00:30:00+01:00"), parse_utc("2025-12-31T23:30:00Z"));
    EXPECT_EQ(parse_utc("2024-02-28 23:30:00-01:00"), parse_utc("2024-02-29T00:30:00Z"));
    // The leap second at the end of 2016 came at eight in the morning in Shanghai.
    EXPECT_EQ(parse_utc("2017-01-01T07:59:60+08:00"), parse_utc("2016-12-31T23:59:60Z"));
    for (const char* text :
         {"2026-03-20 14:00:00+", "2026-03-20 14:00:00+1", "2026-03-20 14:00:00+24:00",
          "2026-03-20 14:00:00+01:60", "2026-03-20 14:00:00+01:00Z", "2026-03-20 14:00:00Z+01:00",
          "2026-03-20 14:00:00 +01:0", "2026-03-20 25:00:00+02:00", "2026-03-20 14:60:00+02:00",
          "2026-03-20 14:00:00+010000", "2026-02-30 14:00:00+02:00"})
        EXPECT_THROW(parse_utc(text), InputError) << text;
}

TEST(Time, RefusesWhatIsNoTime) {
    for (const char* text : {"", "yesterday", "2026-13-01T00:00:00Z", "2026-01-01", "2026-01-01T00:00:nanZ",
                             "1066-10-14T09:00:00Z"})
        EXPECT_THROW(parse_utc(text), InputError) << text;
}

}  // namespace
}  // namespace hilcam
