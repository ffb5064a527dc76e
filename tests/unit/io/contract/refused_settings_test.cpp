#include "io/contract/refused_settings.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

CameraLimits limits() {
    CameraLimits l;
    l.min_exposure_s = 1e-5, l.max_exposure_s = 1;
    l.min_gain_db = 0, l.max_gain_db = 24;
    l.min_frame_rate_hz = 1, l.max_frame_rate_hz = 60;
    l.max_binning = 4;
    return l;
}
std::string refusal(const SettingsChange& change, const CameraSettings& now = {},
                    const CameraLimits& l = limits()) {
    return refusal_of(change, now, l);
}

TEST(RefusedSettings, NameTheValueWithItsLimits) {
    EXPECT_EQ(refusal({.exposure_s = 5}), "exposure_s: found 5; accepted: 1e-05 to 1");
    EXPECT_EQ(refusal({.gain_db = -1}), "gain_db: found -1; accepted: 0 to 24");
    EXPECT_EQ(refusal({.exposure_s = 0.1, .frame_rate_hz = 100}),
              "frame_rate_hz: found 100; accepted: 1 to 60");
    EXPECT_EQ(refusal({.binning_x = 3}), "binning_x: found 3; accepted: 1, 2, 4 and so on up to 4");
    EXPECT_EQ(refusal({.burst_frames = 0}), "burst_frames: found 0; accepted: 1 to 65535");
    EXPECT_EQ(refusal({.trigger_divider = 0}), "trigger_divider: found 0; accepted: 1 to 65535");
}

TEST(RefusedSettings, SayWhatAWidthDoesNotGoWith) {
    const SettingsChange width{.exposure_mode = ExposureMode::kTriggerWidth};
    CameraSettings automatic, any_edge, level;
    automatic.automatic_exposure = true;
    level.trigger_activation = TriggerActivation::kLevelLow;
    EXPECT_EQ(
        refusal(width, level),
        "exposure_mode: trigger_width and trigger_activation level_high and level_low exclude each other");
    any_edge.trigger_activation = TriggerActivation::kAnyEdge;
    EXPECT_EQ(refusal(width, automatic),
              "exposure_mode: trigger_width and automatic_exposure exclude each other");
    EXPECT_EQ(refusal(width, any_edge),
              "exposure_mode: trigger_width and trigger_activation any_edge exclude each other");
    CameraLimits lockstep = limits(), scanning = limits();
    lockstep.lockstep = scanning.exposure_is_own = scanning.frame_rate_is_own = true;
    EXPECT_EQ(refusal(width, {}, lockstep),
              "exposure_mode: trigger_width needs real time, and this is lockstep");
    EXPECT_EQ(refusal({.trigger_activation = TriggerActivation::kLevelHigh}, {}, lockstep),
              "trigger_activation: level_high and level_low need real time, and this is lockstep");
    EXPECT_EQ(refusal(width, {}, scanning),
              "exposure_mode: trigger_width needs an exposure that the camera does not set itself");
    EXPECT_EQ(refusal({.trigger_overlap = TriggerOverlap::kOff}, {}, scanning),
              "trigger_overlap: a line scanner's frames join without a gap");
}

TEST(RefusedSettings, SayWhoSetsWhatIsNotToBeSet) {
    CameraSettings automatic;
    automatic.automatic_exposure = true;
    EXPECT_EQ(refusal({.exposure_s = 0.1}, automatic),
              "exposure_s: the camera sets it itself (automatic_exposure is on)");
    CameraLimits scanning = limits();
    scanning.frame_rate_is_own = true;
    EXPECT_EQ(refusal({.frame_rate_hz = 10}, {}, scanning),
              "frame_rate_hz: the camera sets it itself (a sequence, or a line-scan shutter)");
    EXPECT_EQ(refusal({.automatic_exposure = true}), "automatic_exposure: this camera does not have it");
    EXPECT_EQ(refusal({.running = true}), "the camera cannot set this now");
}

}  // namespace
}  // namespace hilcam
