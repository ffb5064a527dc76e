#include "emulator/scenario/apart_refusal.h"

#include <gtest/gtest.h>

#include "emulator/scenario/app_config.h"

namespace hilcam {
namespace {

std::string refusal(const std::vector<std::string>& overrides) {
    const ScenarioConfig s =
        load_scenario(std::string(HILCAM_SOURCE_DIR) + "/tests/protocol/minimal_scenario.yaml", overrides);
    std::vector<RenderQuality> levels = lower_levels(s);
    levels.insert(levels.begin(), render_quality_of(s));
    return apart_refusal(s, levels);
}

TEST(ApartRefusal, NamesWhatKeepsPicturesTogether) {
    EXPECT_EQ(refusal({}), "");
    EXPECT_EQ(refusal({"quality.motion=fast"}), "");
    EXPECT_EQ(refusal({"quality.motion=exact"}).substr(0, 28), "quality.motion: found exact,");
    EXPECT_EQ(refusal({"quality.noise_budget=0.2"}).substr(0, 44),
              "quality.noise_budget: found more than 0, whi");
    EXPECT_EQ(refusal({"quality.noise_budget=0.2"}).find('\n'), std::string::npos);
}

// A line that scans has one instant a row, whatever is asked for.
TEST(ApartRefusal, AScanningLineIsNeverOfSeveralInstants) {
    EXPECT_EQ(refusal({"quality.motion=exact", "camera.shutter={kind: line_scan, line_time_us: 50}"}), "");
}

TEST(ApartRefusal, NamesTheLevelThatFramesMayHave) {
    EXPECT_EQ(refusal({"loop.frame_budget_ms=10", "loop.levels=[{samples_per_axis: 1}, {noise_budget: 0.5}]",
                       "quality.samples_per_axis=2"})
                  .substr(0, 28),
              "loop.levels.1.noise_budget: ");
}

}  // namespace
}  // namespace hilcam
