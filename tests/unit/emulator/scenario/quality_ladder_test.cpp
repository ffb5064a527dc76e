#include "emulator/scenario/quality_ladder.h"

#include <gmock/gmock.h>

#include "emulator/scenario/app_config.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

RenderQuality shipped(const std::string& name) {
    QualityConfig quality;
    read_config(std::string(HILCAM_SOURCE_DIR) + "/configs/quality/" + name, section_of(quality));
    return quality.render;
}

class LadderTest : public FilesTest {
  protected:
    LoopConfig loop(const std::string& text) {
        LoopConfig config;
        read_config(write("loop.yaml", text), section_of(config));
        return config;
    }
};

TEST_F(LadderTest, ALevelChangesWhatItNamesAndKeepsTheRest) {
    write("fast.yaml", "path_model: direct\nlod_error_px: 2\n");
    const LoopConfig config = loop("frame_budget_ms: 16.6\nlevels: [{max_depth: 3}, fast.yaml]\n");
    EXPECT_DOUBLE_EQ(config.frame_budget_s, 16.6e-3);
    ASSERT_EQ(config.levels.size(), 2u);
    const RenderQuality base = shipped("reference.yaml");
    EXPECT_EQ(difference(base, applied(base, config.levels[0])), "max_depth 3");
    EXPECT_EQ(difference(base, applied(base, config.levels[1])), "path_model direct, lod_error_px 2");
}

TEST_F(LadderTest, WhatCannotChangeBetweenFramesIsRefused) {
    try {
        loop("levels: [{guard_px: 3}]\n");
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("guard_px"));
        EXPECT_THAT(error.what(), HasSubstr("levels.0"));
    }
    std::string many = "levels: [";
    for (std::size_t i = 0; i < kMaxLevels; ++i) many += std::string(i ? ", " : "") + "{max_depth: 1}";
    EXPECT_THROW(loop(many + "]\n"), InputError);
}

TEST(QualityLadder, ALevelMayLeaveTheBufferAndNotTakeOne) {
    QualityLevelConfig rays, buffer;
    rays.values.visibility = "rays", rays.given["visibility"] = true;
    buffer.values.visibility = "buffer", buffer.given["visibility"] = true;
    RenderQuality base = shipped("realtime.yaml");
    ASSERT_TRUE(base.uses_buffer());
    EXPECT_EQ(difference(base, applied(base, rays)), "visibility rays");
    base.visibility = "rays";
    EXPECT_EQ(difference(base, applied(base, buffer)), "");
}

// Every step is a real one, none is better than the one before in anything, and the last is the least there
// is.
TEST(QualityLadder, TheBuiltInOneGoesDownFromEveryShippedQuality) {
    for (const std::string name :
         {"reference.yaml", "still.yaml", "balanced.yaml", "realtime.yaml", "fast.yaml"}) {
        RenderQuality last = shipped(name);
        last.noise_budget = name == "reference.yaml" ? 0.1 : 0;
        const std::vector<RenderQuality> levels = built_in_levels(last);
        EXPECT_GE(levels.size(), 3u) << name;
        EXPECT_LT(levels.size(), kMaxLevels);
        for (const RenderQuality& q : levels) {
            EXPECT_NE(difference(last, q), "");
            EXPECT_LE(q.samples_per_axis, last.samples_per_axis);
            EXPECT_LE(q.max_depth, last.max_depth);
            EXPECT_GE(q.contribution_threshold, last.contribution_threshold);
            EXPECT_GE(q.lod_error_px, last.lod_error_px);
            EXPECT_LE(q.sun_disk, last.sun_disk);
            // A smaller budget is more work, none at all the least.
            EXPECT_TRUE(q.noise_budget == 0 || q.noise_budget >= last.noise_budget);
            EXPECT_FALSE(last.noise_budget == 0 && q.noise_budget > 0);
            last = q;
        }
        EXPECT_EQ(last.path_model, "direct");
        EXPECT_EQ(last.visibility, "rays");
        EXPECT_TRUE(built_in_levels(last).empty());
    }
}

// Nothing else makes ground that is alone faster.
TEST(QualityLadder, GroundAloneGoesToEverySecondPixel) {
    RenderQuality ground = shipped("realtime.yaml");
    ground.buffer_samples = 1, ground.path_model = "direct", ground.max_depth = 1;
    ASSERT_TRUE(ground.sees_ground());
    const std::vector<RenderQuality> levels = built_in_levels(ground);
    ASSERT_EQ(levels.size(), 1u);
    EXPECT_EQ(difference(ground, levels.front()), "ground_step_px 2");
    EXPECT_TRUE(built_in_levels(levels.front()).empty());
}

TEST(QualityLadder, TheSensorIsToldOfEveryRayGrid) {
    ScenarioConfig s;
    s.quality.render.samples_per_axis = 4;
    s.quality.render.noise_budget = 0.2;
    EXPECT_EQ(sampling_of(s).samples_per_axis, kScatteredRays);
    EXPECT_TRUE(sampling_of(s).other_grids.empty());
    s.loop.frame_budget_s = 0.01;
    EXPECT_EQ(sampling_of(s).other_grids, std::vector<RayGrid>{1});
}

}  // namespace
}  // namespace hilcam
