#include "emulator/scenario/apart_refusal.h"

#include <gtest/gtest.h>

#include "emulator/scenario/app_config.h"

namespace hilcam {
namespace {

std::string refusal(const std::vector<std::string>& overrides) {
    return apart_refusal(
        load_scenario(std::string(HILCAM_SOURCE_DIR) + "/tests/protocol/minimal_scenario.yaml", overrides));
}

TEST(ApartRefusal, NamesWhatKeepsPicturesTogether) {
    EXPECT_EQ(refusal({}), "");
    EXPECT_EQ(refusal({"quality.motion=fast"}), "");
    EXPECT_EQ(refusal({"quality.motion=exact"}).substr(0, 28), "quality.motion: found exact,");
}

// A line that scans has one instant a row, whatever is asked for.
TEST(ApartRefusal, AScanningLineIsNeverOfSeveralInstants) {
    EXPECT_EQ(refusal({"quality.motion=exact", "camera.shutter={kind: line_scan, line_time_us: 50}"}), "");
}

}  // namespace
}  // namespace hilcam
