#include "emulator/tradeoff/tradeoff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emulator/scenario/quality_ladder.h"
#include "emulator/tradeoff/tradeoff_combinations.h"
#include "emulator/tradeoff/tradeoff_ladder.h"
#include "io/config/config_manual.h"
#include "io/config/config_yaml.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Choices = std::vector<std::size_t>;

ScenarioSource minimal(std::vector<std::string> overrides = {}) {
    return {std::filesystem::path(HILCAM_SOURCE_DIR) / "tests/protocol/minimal_scenario.yaml",
            std::move(overrides)};
}

const Knob* find(const std::vector<Knob>& knobs, const std::string& name) {
    for (const Knob& knob : knobs)
        if (knob.name == name) return &knob;
    return nullptr;
}

std::vector<std::string> labels(const Knob& knob) {
    std::vector<std::string> out;
    for (const KnobValue& value : knob.others) out.push_back(value.label);
    return out;
}

TEST(TradeoffKnobs, HaveTheScenariosOwnValueAndOthers) {
    const auto knobs = knobs_of(minimal({"quality.max_depth=3"}));
    const Knob* depth = find(knobs, "depth");
    ASSERT_TRUE(depth);
    EXPECT_EQ(depth->own.label, "3");
    EXPECT_THAT(labels(*depth), ElementsAre("1", "2", "4", "6"));
    const Knob* motion = find(knobs, "motion");
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->own.label, "fast");
    EXPECT_THAT(labels(*motion), ElementsAre("off", "exact, 1 px", "exact, 0.25 px"));
}

TEST(TradeoffKnobs, AreThoseThatTheScenarioHasAUseFor) {
    EXPECT_FALSE(find(knobs_of(minimal()), "atmosphere"));
    EXPECT_FALSE(find(knobs_of(minimal()), "terrain edge px"));
    const auto knobs = knobs_of(minimal({"atmosphere.model=precomputed", "objects=[]"}));
    ASSERT_TRUE(find(knobs, "atmosphere"));
    EXPECT_THAT(labels(*find(knobs, "atmosphere")), ElementsAre("none"));
    EXPECT_FALSE(find(knobs, "LOD error px"));
    EXPECT_FALSE(find(knobs, "path model"));
}

TEST(TradeoffKnobs, EveryValueIsAcceptedAndDiffers) {
    const ScenarioSource source = minimal();
    for (const Knob& knob : knobs_of(source))
        for (const KnobValue& value : knob.others) {
            ScenarioConfig own = source.load(), other = source.load(value.overrides);
            const std::string key = value.overrides[0].substr(0, value.overrides[0].find('='));
            EXPECT_NE(value_text(section_of(own), key), value_text(section_of(other), key)) << knob.name;
        }
}

TEST(TradeoffKnobs, BinsAreMergedOrDivided) {
    const std::vector<double> edges = {0.4, 0.5, 0.6, 0.72, 0.96};
    EXPECT_THAT(regrouped_edges_um(edges, 1), ElementsAre(0.4, 0.96));
    EXPECT_THAT(regrouped_edges_um(edges, 2), ElementsAre(0.4, 0.6, 0.96));
    EXPECT_THAT(regrouped_edges_um(edges, 4), testing::ElementsAreArray(edges));
    const auto eight = regrouped_edges_um(edges, 8);
    ASSERT_EQ(eight.size(), 9u);
    EXPECT_NEAR(eight[1], 0.45, 1e-12);
    EXPECT_NEAR(eight[7], 0.84, 1e-12);
    EXPECT_EQ(eight[8], 0.96);
}

TEST(TradeoffKnobs, TheReferenceIsFinerThanTheScenario) {
    const ScenarioSource source = minimal();
    const ScenarioConfig reference = source.load(reference_overrides(source.load()));
    EXPECT_EQ(reference.spectrum_edges_um.size(), 9u);  // of 2 bins
    EXPECT_EQ(reference.quality.render.samples_per_axis * reference.quality.oversampling, 8);
    EXPECT_EQ(reference.quality.render.lod_error_px, 0);
    EXPECT_EQ(reference.quality.psf, PsfMethod::kFft);
    // 4096 x 4096 px leave room for no finer grid than the detector's.
    const ScenarioSource large = minimal({"camera.width_px=4096", "camera.height_px=4096"});
    const ScenarioConfig coarse = large.load(reference_overrides(large.load()));
    EXPECT_EQ(coarse.quality.oversampling, 1);
    EXPECT_EQ(coarse.quality.render.samples_per_axis, 8);
}

TEST(TradeoffKnobs, OfTwoValuesForAKeyTheLaterCounts) {
    EXPECT_THAT(joined_overrides({"a.b=1", "a.bc=2"}, {"a.b=3"}), ElementsAre("a.bc=2", "a.b=3"));
    EXPECT_EQ(minimal({"quality.max_depth=3"}).load({"quality.max_depth=5"}).quality.render.max_depth, 5);
}

class TradeoffFiles : public FilesTest {};

TEST_F(TradeoffFiles, APresetReadsBackAsItWas) {
    const ScenarioConfig s = minimal().load({"quality.motion=exact", "quality.motion_error_px=0.1",
                                             "quality.psf=fft", "quality.facets_behind_diffuse=0"});
    const auto file = write("preset.yaml", quality_yaml(s));
    EXPECT_EQ(quality_yaml(minimal().load({"quality=" + file.string()})), quality_yaml(s));
    EXPECT_THAT(quality_yaml(s), HasSubstr("motion: exact\n"));
}

// --- combinations
// -----------------------------------------------------------------------------------------------------

MeasuredSetting measured(MeasuredSetting::Kind kind, Choices choices, double frame_ms, double error) {
    MeasuredSetting s;
    s.kind = kind;
    s.choices = std::move(choices);
    s.times.frame_ms = frame_ms;
    s.errors.noise.rms = error;
    return s;
}

TEST(TradeoffCombinations, AreOfEachKnobsFrontAndThePromisingFirst) {
    using Kind = MeasuredSetting::Kind;
    const Knob two{"", {"", {}}, {{"a", {}}, {"b", {}}}, KnobRole::kAlways};
    const std::vector<Knob> knobs = {two, two};
    const std::vector<MeasuredSetting> settings = {
        measured(Kind::kOwn, {0, 0}, 10, 1),        //
        measured(Kind::kSingle, {1, 0}, 20, 0.8),   // slower and better
        measured(Kind::kSingle, {2, 0}, 30, 0.9),   // beaten by the one before
        measured(Kind::kSingle, {0, 1}, 5, 1.5),    // faster and worse
        measured(Kind::kSingle, {0, 2}, 15, 0.85),  // slower and better
    };
    // Fronts: {0, 1} and {1, 0, 2}. Without what is measured already: (1, 1) and (1, 2). Promised: 20 / 10 *
    // 5 = 10 ms and sqrt(1.5^2 + 0.8^2 - 1) = 1.37; 20 / 10 * 15 = 30 ms and sqrt(0.8^2 + 0.85^2 - 1) = 0.60.
    // Both are on their front.
    EXPECT_THAT(promising_combinations(knobs, settings, 256), ElementsAre(Choices{1, 1}, Choices{1, 2}));
}

TEST(TradeoffCombinations, LeaveOutValuesThatDoNothing) {
    using Kind = MeasuredSetting::Kind;
    const Knob one{"", {"", {}}, {{"a", {}}}, KnobRole::kAlways};
    const std::vector<Knob> knobs = {one, one};
    // The second's only value is 1 % faster and as accurate: the clock's own.
    EXPECT_TRUE(
        promising_combinations(knobs,
                               {measured(Kind::kOwn, {0, 0}, 10, 1), measured(Kind::kSingle, {1, 0}, 20, 0.8),
                                measured(Kind::kSingle, {0, 1}, 9.9, 1)},
                               256)
            .empty());
}

TEST(TradeoffKnobs, ThatAreIdleAreReset) {
    const std::vector<Knob> knobs = {{"", {"path", {}}, {{"direct", {}}}, KnobRole::kPathModel},
                                     {"", {"2", {}}, {{"1", {}}, {"3", {}}}, KnobRole::kDepth},
                                     {"", {"", {}}, {{"a", {}}}, KnobRole::kBounces},
                                     {"", {"", {}}, {{"a", {}}}, KnobRole::kAlways}};
    const auto reset = [&](Choices choices) {
        reset_idle(knobs, choices);
        return choices;
    };
    EXPECT_EQ(reset({0, 2, 1, 1}), (Choices{0, 2, 1, 1}));
    EXPECT_EQ(reset({0, 1, 1, 1}), (Choices{0, 1, 0, 1}));  // one surface: nothing bounces
    EXPECT_EQ(reset({1, 2, 1, 1}), (Choices{1, 0, 0, 1}));  // direct
}

TEST(TradeoffCombinations, AreNoneOfOneKnob) {
    using Kind = MeasuredSetting::Kind;
    const std::vector<Knob> knobs = {{"", {"", {}}, {{"a", {}}}, KnobRole::kAlways}};
    EXPECT_TRUE(promising_combinations(
                    knobs, {measured(Kind::kOwn, {0}, 10, 1), measured(Kind::kSingle, {1}, 20, 0.5)}, 256)
                    .empty());
}

TEST(TradeoffCombinations, OfManyKnobsAreLimited) {
    using Kind = MeasuredSetting::Kind;
    const Knob knob{"", {"", {}}, {{"a", {}}, {"b", {}}}, KnobRole::kAlways};
    const std::vector<Knob> knobs(14, knob);  // 3^14 are 4.8 million
    std::vector<MeasuredSetting> settings = {measured(Kind::kOwn, Choices(14, 0), 10, 1)};
    for (std::size_t k = 0; k < 14; ++k)
        for (std::size_t choice : {1u, 2u}) {
            Choices choices(14, 0);
            choices[k] = choice;
            settings.push_back(measured(Kind::kSingle, choices,
                                        choice == 1 ? 9 - 0.1 * static_cast<double>(k) : 12,
                                        choice == 1 ? 1.2 : 0.8));
        }
    const auto list = promising_combinations(knobs, settings, 256);
    EXPECT_EQ(list.size(), 256u);
    for (const Choices& choices : list)
        EXPECT_GE(std::count_if(choices.begin(), choices.end(), [](std::size_t c) { return c != 0; }), 2);
}

// --- the governor's ladder

// A knob of these values, the first one the scenario's own.
Knob knob_of_quality(const std::string& key, const std::vector<std::string>& values) {
    Knob knob{key, {values.front(), {}}, {}, KnobRole::kAlways};
    for (std::size_t i = 1; i < values.size(); ++i)
        knob.others.push_back({values[i], {"quality." + key + "=" + values[i]}});
    return knob;
}

class TradeoffLadder : public FilesTest {
  protected:
    Tradeoff tradeoff;

    TradeoffLadder() {
        tradeoff.frame_ms = 16.5;
        tradeoff.knobs = {knob_of_quality("max_depth", {"3", "2", "1"}),
                          knob_of_quality("lod_error_px", {"0.5", "2"}),
                          knob_of_quality("guard_px", {"28", "8"})};
    }
    void add(Choices choices, double frame_ms, double error) {
        MeasuredSetting s = measured(MeasuredSetting::Kind::kSingle, std::move(choices), frame_ms, error);
        s.errors.noise.p99 = error;
        tradeoff.settings.push_back(s);
    }
};

TEST_F(TradeoffLadder, IsTheFrontOfWhatMayChangeBetweenFramesBestFirst) {
    add({0, 0, 0}, 20, 1);
    add({2, 0, 0}, 10, 4);
    add({1, 0, 0}, 15, 2);
    add({0, 1, 0}, 16, 3);  // beaten by the one before
    add({0, 0, 1}, 12, 1);  // the guard band is fixed for a run
    add({2, 1, 0}, 9, 5);
    add({0, 1, 1}, 25, 0.5);  // slower
    const ScenarioConfig s = minimal().load({"loop=" + write("loop.yaml", ladder_yaml(tradeoff)).string()});
    EXPECT_NEAR(s.loop.frame_budget_s, 0.0165, 1e-9);
    ASSERT_EQ(s.loop.levels.size(), 3u);
    EXPECT_EQ(s.loop.levels[0].values.max_depth, 2);
    EXPECT_FALSE(s.loop.levels[0].has_lod_error_px);
    EXPECT_EQ(s.loop.levels[1].values.max_depth, 1);
    EXPECT_TRUE(s.loop.levels[2].has_max_depth && s.loop.levels[2].has_lod_error_px);
}

TEST_F(TradeoffLadder, IsNoneWhereNothingIsFaster) {
    add({0, 0, 0}, 20, 1);
    add({1, 0, 0}, 21, 0.5);
    EXPECT_EQ(ladder_yaml(tradeoff), "");
}

TEST_F(TradeoffLadder, OfManyRungsKeepsBothEnds) {
    std::vector<std::string> depths = {"40"};
    for (int depth = 39; depth > 0; --depth) depths.push_back(std::to_string(depth));
    tradeoff.knobs = {knob_of_quality("max_depth", depths)};
    for (std::size_t i = 0; i < 40; ++i) add({i}, 50 - static_cast<double>(i), std::pow(1.2, i));
    const ScenarioConfig s = minimal().load({"loop=" + write("loop.yaml", ladder_yaml(tradeoff)).string()});
    ASSERT_EQ(s.loop.levels.size(), kMaxLevels - 1);
    EXPECT_EQ(s.loop.levels.front().values.max_depth, 39);
    EXPECT_EQ(s.loop.levels.back().values.max_depth, 1);
}

}  // namespace
}  // namespace hilcam
