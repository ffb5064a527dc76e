#include "emulator/scenario/quality_ladder.h"

#include <gmock/gmock.h>

#include <functional>

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

std::string refusal_of(const std::function<void()>& read) {
    try {
        read();
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST_F(LadderTest, TheBudgetIsOfTheRateUnlessItIsANumber) {
    EXPECT_TRUE(loop("prefer: latency\n").budget_is_of_rate());
    EXPECT_TRUE(loop("frame_budget_ms: auto\n").budget_is_of_rate());
    EXPECT_FALSE(loop("frame_budget_ms: 0\n").budget_is_of_rate());
    EXPECT_THAT(
        refusal_of([&] { loop("prefer: latency\nframe_budget_ms: often\n"); }),
        HasSubstr("loop.yaml:2:18: frame_budget_ms: found 'often'; accepted: a number, 0 to 1000000, or "
                  "'auto'"));
    EXPECT_THAT(refusal_of([&] { loop("frame_budget_ms: -1\n"); }), HasSubstr("found '-1'"));
}

TEST_F(LadderTest, FixedLevelsTakeNoBudget) {
    EXPECT_TRUE(loop("levels: fixed\n").levels_fixed);
    EXPECT_TRUE(loop("levels: fixed\nframe_budget_ms: 0\n").levels_fixed);
    EXPECT_FALSE(loop("levels: [{max_depth: 1}]\n").levels_fixed);
    EXPECT_THAT(refusal_of([&] { loop("frame_budget_ms: 20\nlevels: fixed\n"); }),
                HasSubstr("loop.yaml:2:9: levels: found 'fixed' beside a frame_budget_ms of 20"));
    EXPECT_THAT(refusal_of([&] { loop("levels: free\n"); }),
                HasSubstr("loop.yaml:1:9: levels: found 'free'; accepted: a list of mappings, or 'fixed'"));
}

// A rate is held by who runs in real time, and where frames may depend on the machine.
TEST(QualityLadder, ABudgetOfTheRateIsForRunsThatHoldOne) {
    ScenarioConfig s;
    s.quality.render = shipped("realtime.yaml");
    EXPECT_THAT(governor_off(s), HasSubstr("auto"));
    EXPECT_TRUE(lower_levels(s).empty());
    s.loop.holds_rate = true;
    EXPECT_EQ(governor_off(s), "");
    EXPECT_FALSE(lower_levels(s).empty());
    ScenarioConfig fixed = s, without = s, lockstep = s;
    fixed.loop.levels_fixed = true;
    EXPECT_THAT(governor_off(fixed), HasSubstr("fixed"));
    without.loop.frame_budget_s = 0;
    EXPECT_THAT(governor_off(without), HasSubstr("is 0"));
    lockstep.mode = CameraMode::kLockstep;
    EXPECT_THAT(governor_off(lockstep), HasSubstr("lockstep"));
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
        const std::string visibility = last.visibility;
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
            last = q;
        }
        EXPECT_EQ(last.path_model, "direct");
        // A ray a pixel is hardly faster, and flickers.
        EXPECT_EQ(last.visibility, visibility);
        EXPECT_LE(last.buffer_samples, 16);
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
    EXPECT_EQ(sampling_of(s).samples_per_axis, 4);
    s.quality.render.sun_disk = true;
    EXPECT_EQ(sampling_of(s).samples_per_axis, kScatteredRays);
    EXPECT_TRUE(sampling_of(s).other_grids.empty());
    s.loop.frame_budget_s = 0.01;
    EXPECT_EQ(sampling_of(s).other_grids, (std::vector<RayGrid>{2, 1}));
    // The visibility buffer's samples are where they are.
    s.quality.render.visibility = "buffer";
    EXPECT_EQ(sampling_of(s).samples_per_axis, halved(4));
}

}  // namespace
}  // namespace hilcam
