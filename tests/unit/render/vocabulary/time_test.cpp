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

TEST(Time, RefusesWhatIsNoTime) {
    for (const char* text : {"", "yesterday", "2026-13-01T00:00:00Z", "2026-01-01", "2026-01-01T00:00:nanZ",
                             "1066-10-14T09:00:00Z"})
        EXPECT_THROW(parse_utc(text), InputError) << text;
}

}  // namespace
}  // namespace hilcam
