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
