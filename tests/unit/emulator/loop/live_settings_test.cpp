#include <gtest/gtest.h>

#include <cmath>

#include "emulator/loop/live_settings.h"

namespace hilcam {
namespace {

TEST(LiveSettings, RefusesWhatIsOutsideAndTheLoopSeesTheRest) {
    CameraModel camera;
    LiveSettings settings(camera);
    EXPECT_FALSE(settings.change({.exposure_s = 1e9}));
    EXPECT_FALSE(settings.change({.gain_db = std::nan("")}));
    EXPECT_TRUE(settings.change({.gain_db = 6}));
    EXPECT_EQ(settings.read_in_loop().gain_db, 6);
}

TEST(SettingsHistory, EachHoldFromTheirInstantOnAndTheOldestBeforeAll) {
    SettingsHistory history(CameraSettings{.gain_db = -1});
    EXPECT_EQ(history.at(0).gain_db, -1);
    for (int i = 0; i < 20; ++i) history.add({.gain_db = 1.0 * i}, 10 * i);
    EXPECT_EQ(history.newest().gain_db, 19);
    EXPECT_EQ(history.at(189).gain_db, 18);
    EXPECT_EQ(history.at(190).gain_db, 19);
    EXPECT_EQ(history.at(0).gain_db, 4);  // 16 are kept
    history.add({.gain_db = 20}, 5);      // not before those that were there
    EXPECT_EQ(history.at(189).gain_db, 18);
    EXPECT_EQ(history.at(190).gain_db, 20);
}

// An order that comes just when the loop has looked for the last time, as at the end of --frames.
TEST(LiveSettings, NobodyWaitsForALoopThatHasEnded) {
    LiveSettings settings(CameraModel{}, {.lockstep = true});
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    ASSERT_EQ(settings.order_in_lockstep(order), TriggerResult::kTaken);
    settings.close();
    EXPECT_TRUE(settings.wait_for_order(5)) << "the whole patience";
}

}  // namespace
}  // namespace hilcam
