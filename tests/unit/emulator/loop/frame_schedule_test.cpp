#include <gtest/gtest.h>

#include "emulator/loop/frame_schedule.h"

namespace hilcam {
namespace {

TEST(FrameSchedule, SkipsWholePeriodsAndNeverCatchesUp) {
    FrameSchedule schedule(1000);
    EXPECT_EQ(schedule.take(0, 100).start_ns, 1000);
    EXPECT_EQ(schedule.take(1150, 100).start_ns, 1100);  // late by less than a period: still made
    const FrameSchedule::Slot slot = schedule.take(1555, 100);
    EXPECT_EQ(slot.start_ns, 1500);
    EXPECT_EQ(slot.skipped, 3u);
    EXPECT_EQ(schedule.take(1555, 100).start_ns, 1600);
    EXPECT_EQ(schedule.take(1555, 300).start_ns, 1900);  // a new period counts from the last frame on
}

TEST(FrameSchedule, BeginsLateExposuresWhenTheyCanAndStaysOnItsRaster) {
    FrameSchedule schedule(1000);
    EXPECT_EQ(schedule.take(900, 100, 80).start_ns, 1000);   // in time: not before
    EXPECT_EQ(schedule.take(1150, 100, 80).start_ns, 1150);  // now, not at 1100
    EXPECT_EQ(schedule.take(1160, 100, 80).start_ns, 1200);
    EXPECT_EQ(schedule.take(1395, 100, 80).start_ns, 1380);  // over before 1400, where the next one is
    const FrameSchedule::Slot slot = schedule.take(1770, 100, 80);
    EXPECT_EQ(slot.start_ns, 1770);
    EXPECT_EQ(slot.skipped, 3u);
    EXPECT_EQ(schedule.take(1770, 100, 80).start_ns, 1800);
}

}  // namespace
}  // namespace hilcam
