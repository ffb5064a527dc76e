#include "emulator/bench/pilot.h"

#include <gtest/gtest.h>

#include "emulator/scenario/app_config.h"

namespace hilcam {
namespace {

ScenarioConfig shipped(const char* name) {
    return load_scenario(std::string(HILCAM_SOURCE_DIR "/configs/scenarios/") + name + ".yaml",
                         std::vector<std::string>{});
}

TEST(Pilot, FliesRoundTheFirstObjectFromWhereTheCameraIs) {
    const std::optional<CircleFlight> flight = flight_of_pilot(shipped("geo_inspection"));
    ASSERT_TRUE(flight);
    EXPECT_NEAR(length(flight->start_m - flight->center_m), length(Vec3d{40, 27, 13}), 1e-9);
    EXPECT_EQ(flight->period_s, 120);
}

// Its own motion is the one that it is timed on.
TEST(Pilot, LeavesACameraAloneThatMovesByItself) { EXPECT_FALSE(flight_of_pilot(shipped("leo_inspection"))); }

TEST(Pilot, HasNothingToFlyRoundWithoutAnObject) { EXPECT_FALSE(flight_of_pilot(shipped("earth_day"))); }

}  // namespace
}  // namespace hilcam
