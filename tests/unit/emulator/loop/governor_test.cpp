#include "emulator/loop/governor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

constexpr double kBudget_ms = 16;

// Levels whose frames take what a function of level and frame says.
struct Plant {
    std::function<double(std::size_t level, int frame)> cost_ms;
    std::size_t levels = 4;
    int delay = 2;  // frames until the governor is told
    std::vector<double> costs_ms{};

    struct Outcome {
        std::vector<std::size_t> level;  // of each frame
        int changes = 0;
        int misses = 0;
        // In frames from .. to-1.
        int changes_in(std::size_t from, std::size_t to) const {
            int sum = 0;
            for (std::size_t i = std::max<std::size_t>(from, 1); i < to; ++i)
                sum += level[i] != level[i - 1] ? 1 : 0;
            return sum;
        }
    };
    Outcome run(int frames) const {
        Governor governor({kBudget_ms, levels, costs_ms});
        Outcome out;
        std::vector<double> took_ms;
        for (int i = 0; i < frames; ++i) {
            std::size_t level = governor.level();
            if (i >= delay) {
                const auto told = static_cast<std::size_t>(i - delay);
                level = governor.take(out.level[told], took_ms[told]);
            }
            out.level.push_back(level);
            took_ms.push_back(cost_ms(level, i));
            out.misses += took_ms.back() > kBudget_ms ? 1 : 0;
        }
        out.changes = out.changes_in(0, out.level.size());
        return out;
    }
};

// A plant that does not change: down at most levels - 1 times at first; after that each climb that is taken
// back doubles the hold-off, 10 times from 64 to 65536 frames, then there is one in 65536 frames. Each is two
// changes; a climb may be to a level in between, which holds, before the one that does not.
int max_changes(std::size_t levels, int frames) {
    const int doublings = static_cast<int>(std::log2(Governor::kMaxStay / Governor::kMinStay));
    return 2 * static_cast<int>(levels - 1) + 2 * (doublings + frames / static_cast<int>(Governor::kMaxStay));
}

TEST(Governor, KeepsTheBestLevelThatFitsAndGoesStraightToIt) {
    const Plant plant{
        [](std::size_t level, int) { return 10 + 40.0 / static_cast<double>(1 << (2 * level)); }};
    const Plant::Outcome out = plant.run(2000);  // 50, 20, 12.5, 10.6 ms
    EXPECT_EQ(out.level.back(), 2u);
    // Two levels down: three misses each, and what was under way.
    const int first = Governor::kWarmUp + 2 * (3 + plant.delay);
    EXPECT_EQ(out.level[static_cast<std::size_t>(first)], 2u);
    EXPECT_LE(out.changes, max_changes(4, 2000));
    // It is all but a few frames at the level that fits.
    EXPECT_GT(std::count(out.level.begin(), out.level.end(), 2u), 1900);
}

TEST(Governor, StaysWhereTheBudgetLiesBetweenTwoLevels) {
    for (const double above_ms : {16.1, 20.0, 30.0}) {
        const Plant plant{[&](std::size_t level, int) { return level == 0 ? above_ms : 12.0; }, 2};
        constexpr int kFrames = 1'000'000;
        const Plant::Outcome out = plant.run(kFrames);
        EXPECT_LE(out.changes, max_changes(2, kFrames)) << above_ms;
        EXPECT_GT(out.changes, 1) << above_ms;  // it does look again
        // Of an hour at 60 Hz, the last half: a try in 18 minutes.
        EXPECT_LE(out.changes_in(500'000, kFrames), 2 * (500'000 / 65536 + 1)) << above_ms;
        EXPECT_LT(out.misses, 12 * 40) << above_ms;
    }
}

// No hold-off that grows: the same plant swings all the time. What the test above would see then.
TEST(Governor, ATryEveryLeastStayWouldBeSeen) {
    int changes = 0;
    std::size_t level = 1;
    for (int i = 0, stay = 0; i < 1'000'000; ++i, ++stay)
        if (stay >= (level == 1 ? Governor::kMinStay : 3)) level = 1 - level, stay = 0, ++changes;
    EXPECT_GT(changes, 10 * max_changes(2, 1'000'000));
}

TEST(Governor, NoiseIsNoReasonToSwing) {
    std::mt19937 engine(5);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    // Ten percent of noise about means on both sides of the budget, and a hiccup of 100 ms in 200 frames.
    for (const double upper_ms : {13.0, 15.0, 15.9, 16.5, 18.0}) {
        const Plant plant{[&](std::size_t level, int) {
                              const double mean_ms = level == 0 ? upper_ms : 0.8 * upper_ms;
                              const double hiccup_ms = uniform(engine) < 1.0 / 200 ? 100 : 0;
                              return mean_ms * (1 + 0.1 * normal(engine)) + hiccup_ms;
                          },
                          3};
        constexpr int kFrames = 500'000;
        const Plant::Outcome out = plant.run(kFrames);
        // Noise may also push it from the middle level to the last and back: levels - 1 times the bound.
        EXPECT_LE(out.changes, 2 * max_changes(3, kFrames)) << upper_ms;
        EXPECT_LE(out.changes_in(250'000, kFrames), 2 * 2 * (250'000 / 65536 + 1)) << upper_ms;
    }
}

TEST(Governor, ASingleHiccupChangesNothing) {
    const Plant plant{[](std::size_t, int frame) { return frame % 40 == 39 ? 200.0 : 10.0; }};
    const Plant::Outcome out = plant.run(5000);
    EXPECT_EQ(out.changes, 0);
}

TEST(Governor, FollowsALoadThatJumpsAndComesBack) {
    // Twice the load from frame 1000 to 3000: 12, 6, 3 ms become 24, 12, 6 ms... of a budget of 16.
    const Plant plant{[](std::size_t level, int frame) {
        const double load = frame >= 1000 && frame < 3000 ? 2 : 1;
        return load * 12 / static_cast<double>(1 << level);
    }};
    const Plant::Outcome out = plant.run(6000);
    EXPECT_EQ(out.level[999], 0u);
    EXPECT_EQ(out.level[1000 + 3 + 2], 1u);  // three misses, told two frames later
    EXPECT_EQ(out.level[2999], 1u);
    // Back when its hold-off is over, however often it had to be taken back meanwhile: a load that has
    // fallen by half is tried after 64 frames or a sixteenth of it.
    const auto back = std::find(out.level.begin() + 3000, out.level.end(), 0u) - out.level.begin();
    EXPECT_LE(back, 3000 + 200);
    EXPECT_EQ(out.level.back(), 0u);
}

// A load that alternates with any period does not make it swing with it for ever.
TEST(Governor, AnAlternatingLoadIsFollowedEverLessOften) {
    for (const int period : {10, 50, 100, 200, 500}) {
        const Plant plant{[&](std::size_t level, int frame) {
                              const double load = frame / period % 2 == 0 ? 20 : 8;
                              return load / (level == 0 ? 1 : 2);
                          },
                          2};
        constexpr int kFrames = 500'000;
        const Plant::Outcome out = plant.run(kFrames);
        // Two changes in kMaxStay / 16 frames at the most, when the hold-off has grown.
        const int least = static_cast<int>(Governor::kMaxStay / 16);
        EXPECT_LE(out.changes_in(250'000, kFrames), 2 * (250'000 / least + 1)) << period;
    }
}

// --- with the costs of levels measured before the run

TEST(Governor, TheFirstFrameHasTheBestLevelWhoseCostLeavesRoom) {
    const Plant plant{
        [](std::size_t level, int) { return 40.0 / static_cast<double>(1 << level); }, 4, 2, {40, 20, 10, 5}};
    const Plant::Outcome out = plant.run(1000);
    EXPECT_EQ(out.level.front(), 2u);
    EXPECT_EQ(out.changes, 0);
    EXPECT_EQ(out.misses, 0);
    // Of 16 ms a cost of 14 leaves no room.
    EXPECT_EQ(Governor({kBudget_ms, 3, {40, 14, 5}}).level(), 2u);
    EXPECT_EQ(Governor({kBudget_ms, 3, {40, 13, 5}}).level(), 1u);
    // Where nothing holds the rate the last level comes nearest.
    EXPECT_EQ(Governor({kBudget_ms, 3, {400, 300, 200}}).level(), 2u);
    // One that took too long to be measured is none to begin with; one below those that were measured may be.
    EXPECT_EQ(Governor({kBudget_ms, 3, {std::numeric_limits<double>::infinity(), 13, 0}}).level(), 1u);
    EXPECT_EQ(Governor({kBudget_ms, 3, {40, 20, 0}}).level(), 2u);
}

TEST(Governor, GoesUpWhenFramesAreCheaperThanBeforeTheRun) {
    // Half of what was measured, when the machine had more to do: 20, 10, 5, 2.5 ms.
    const Plant plant{
        [](std::size_t level, int) { return 20.0 / static_cast<double>(1 << level); }, 4, 2, {40, 20, 10, 5}};
    const Plant::Outcome out = plant.run(900);
    EXPECT_EQ(out.level.front(), 2u);
    const std::int64_t climbs_at = Governor::kWarmUp + Governor::kMinStay + plant.delay;
    EXPECT_EQ(out.level[static_cast<std::size_t>(climbs_at)], 1u);
    EXPECT_EQ(out.level.back(), 1u);
    EXPECT_EQ(out.misses, 0);  // level 0 is not even tried: it would take 20 ms
}

TEST(Governor, ALevelThatShouldBeTooSlowIsTriedLate) {
    for (const double best_ms : {20.0, std::numeric_limits<double>::infinity()}) {
        const Plant plant{
            [&](std::size_t level, int) { return level == 0 ? 20.0 : 10.0; }, 2, 2, {best_ms, 10}};
        const Plant::Outcome out = plant.run(4000);
        EXPECT_EQ(out.changes_in(0, Governor::kDoubtfulStay), 0) << best_ms;
        EXPECT_GT(out.changes, 0) << best_ms;
        EXPECT_LE(out.misses, 3 * (3 + plant.delay)) << best_ms;
        EXPECT_EQ(out.level.back(), 1u) << best_ms;
    }
}

// Three times the load: by what the levels cost those are known that would be too slow as well.
TEST(Governor, FallsPastLevelsThatShouldBeTooSlow) {
    const Plant plant{[](std::size_t level, int frame) {
                          return (frame < 500 ? 1 : 3) * 12.0 / static_cast<double>(1 << level);
                      },
                      5,
                      2,
                      {12, 11.9, 11.9, 6, 3}};
    const Plant::Outcome out = plant.run(520);
    EXPECT_EQ(out.level[499], 0u);
    EXPECT_EQ(out.level.back(), 3u);
    EXPECT_EQ(out.changes, 1);
}

// --- with the budget of a frame rate that clients change

TEST(Governor, AnotherFrameRateIsAnotherChoice) {
    Governor governor({GovernorSettings::kToldBudget_ms, 3, {80, 40, 20}});
    EXPECT_EQ(governor.level(), 0u);
    governor.use_budget(33);
    EXPECT_EQ(governor.level(), 2u);
    governor.use_budget(100);
    EXPECT_EQ(governor.level(), 0u);
    governor.use_budget(50);
    EXPECT_EQ(governor.level(), 1u);
    // Nearly the same budget is no reason to change what runs; that it counts is another thing.
    governor.use_budget(46);
    EXPECT_EQ(governor.level(), 1u);
    EXPECT_EQ(governor.budget_ms(), 46);
}

TEST(Governor, RestsAtTheBestLevelWhileFramesMayTakeAsLongAsTheyLike) {
    Governor governor({GovernorSettings::kToldBudget_ms, 3, {80, 40, 20}});
    governor.use_budget(33);
    governor.use_budget(0);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(governor.take(0, 1e6), 0u);
    governor.use_budget(33);
    EXPECT_EQ(governor.level(), 2u);
}

TEST(Governor, NeverLeavesTheLadder) {
    std::mt19937 engine(3);
    const auto draw = [&](double most) { return std::uniform_real_distribution<double>(0, most)(engine); };
    for (int run = 0; run < 200; ++run) {
        const auto levels = static_cast<std::size_t>(2 + draw(14));
        std::vector<double> costs_ms(static_cast<std::size_t>(draw(20)));
        for (double& cost : costs_ms)
            cost = draw(1) < 0.1 ? std::numeric_limits<double>::infinity() : std::max(0.0, draw(60) - 5);
        Governor governor({GovernorSettings::kToldBudget_ms, levels, costs_ms});
        for (int frame = 0; frame < 500; ++frame) {
            if (frame % 50 == 0) governor.use_budget(draw(1) < 0.2 ? 0 : draw(50));
            const std::size_t level = governor.take(governor.level(), draw(60));
            ASSERT_LT(level, levels);
            ASSERT_EQ(level, governor.level());
        }
    }
}

TEST(Governor, OffWithoutABudgetOrLevels) {
    for (const GovernorSettings& settings :
         {GovernorSettings{0, 4}, GovernorSettings{16, 1}, GovernorSettings{0, 4, {100, 1}}}) {
        Governor governor(settings);
        governor.use_budget(10);
        for (int i = 0; i < 1000; ++i) EXPECT_EQ(governor.take(0, 1e6), 0u);
    }
}

TEST(Governor, StopsAtTheLastLevel) {
    const Plant plant{[](std::size_t, int) { return 100.0; }};
    const Plant::Outcome out = plant.run(1000);
    EXPECT_EQ(out.level.back(), 3u);
    EXPECT_EQ(out.changes, 3);
}

// --- in the loop

class GovernedLoopTest : public PlateTest {};

TEST_F(GovernedLoopTest, FramesThatAreTooSlowGoDownTheLadderAndSaySo) {
    const auto file = scenario("",
                               "loop: {frame_budget_ms: 0.001, levels: [{max_depth: 1}, {max_depth: 1, "
                               "path_model: direct}]}\n");
    const std::vector<std::string> fast = {"camera.exposure_ms=1", "camera.frame_rate_hz=200"};
    const ScenarioConfig config = load_scenario(file, fast);
    const GovernorSettings governor{1e3 * config.loop.frame_budget_s, 1 + lower_levels(config).size()};
    ASSERT_EQ(governor.levels, 3u);
    LoopRig rig(file, {.frames = 60, .governor = governor}, fast);
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(60));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    EXPECT_EQ(frames.front().record.quality_level, 0u);
    EXPECT_EQ(frames.back().record.quality_level, 2u);
    EXPECT_EQ(rig.loop.counters().level_changes.load(), 2u);
    std::uint64_t sum = 0;
    for (const auto& count : rig.loop.counters().frames_at_level) sum += count.load();
    EXPECT_EQ(sum, 60u);
    LevelChange change;
    for (std::size_t to = 1; to <= 2; ++to) {
        ASSERT_TRUE(rig.loop.take_level_change(change));
        EXPECT_EQ(change.from, to - 1);
        EXPECT_EQ(change.to, to);
        EXPECT_GT(change.mean_ms, governor.budget_ms);
        const auto first = std::find_if(frames.begin(), frames.end(),
                                        [&](const auto& f) { return f.record.quality_level == to; });
        EXPECT_EQ(first->record.id, change.frame);
    }
    EXPECT_FALSE(rig.loop.take_level_change(change));
}

// The camera's rate is the budget, by what settings and triggers make of it while the loop runs.
TEST_F(GovernedLoopTest, ABudgetOfTheRateFollowsTheRateThatAClientSets) {
    const auto file =
        scenario(", frame_rate_hz: 100, frame_rate_range_hz: [0.5, 100], exposure_range_ms: [0.1, 20]",
                 "loop: {frame_budget_ms: 1000, levels: [{max_depth: 1}, {path_model: direct}]}\n");
    const std::vector<std::string> shorter = {"camera.exposure_ms=1"};
    // Costs that no frame here has: only what is chosen by them matters.
    LoopRig rig(file, {.governor = {GovernorSettings::kToldBudget_ms, 3, {600, 300, 1}}}, shorter);
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(3));
    EXPECT_NEAR(rig.loop.counters().budget_ms.load(), 10, 1e-6);
    SettingsCommand slower;
    slower.frame_rate_hz = 1;
    EXPECT_EQ(rig.send(slower), CommandStatus::kAccepted);
    const std::size_t before = rig.collector.count();
    ASSERT_TRUE(rig.collector.wait_for(before + 2));
    EXPECT_NEAR(rig.loop.counters().budget_ms.load(), 1000, 1e-6);
    rig.loop.stop();
    EXPECT_EQ(rig.collector.frames.front().record.quality_level, 2u);
    EXPECT_EQ(rig.collector.frames.back().record.quality_level, 0u);
    LevelChange change;
    ASSERT_TRUE(rig.loop.take_level_change(change));
    EXPECT_EQ(change.from, 2u);
    EXPECT_EQ(change.to, 0u);
    EXPECT_NEAR(change.budget_ms, 1000, 1e-6);
    EXPECT_FALSE(rig.loop.take_level_change(change));
}

TEST_F(GovernedLoopTest, TriggeredFramesHaveNoBudgetOfARate) {
    const auto file =
        scenario("", "mode: triggered\nloop: {frame_budget_ms: 1000, levels: [{max_depth: 1}]}\n");
    LoopRig rig(file, {.governor = {GovernorSettings::kToldBudget_ms, 2, {1e6, 1}}});
    rig.loop.start();
    EXPECT_EQ(rig.send(ExposeCommand{{}, 3}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(3));
    rig.loop.stop();
    for (const auto& frame : rig.collector.frames) EXPECT_EQ(frame.record.quality_level, 0u);
    EXPECT_EQ(rig.loop.counters().budget_ms.load(), 0);
}

// Ten times slower: a frame has ten times as long.
TEST_F(GovernedLoopTest, TheBudgetIsInTheMachinesTime) {
    const auto file =
        scenario(", frame_rate_hz: 100, frame_rate_range_hz: [0.5, 100]",
                 "clock: {scale: 0.1}\nloop: {frame_budget_ms: 1000, levels: [{max_depth: 1}]}\n");
    const std::vector<std::string> shorter = {"camera.exposure_ms=1"};
    LoopRig rig(file, {.governor = {GovernorSettings::kToldBudget_ms, 2}}, shorter);
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(2));
    rig.loop.stop();
    EXPECT_NEAR(rig.loop.counters().budget_ms.load(), 100, 1e-5);
}

// With latency frames are made one after the other: none begins before the one before is out. Their pixels
// are those of throughput.
TEST_F(GovernedLoopTest, PreferringLatencyFramesDoNotOverlapAndAreTheSame) {
    const auto file = scenario("", "mode: lockstep\n");
    std::vector<std::vector<std::uint16_t>> pictures[2];
    for (const LoopPreference prefer : {LoopPreference::kThroughput, LoopPreference::kLatency}) {
        LoopRig rig(file, {.prefer = prefer});
        rig.loop.start();
        EXPECT_EQ(rig.send(ExposeCommand{{}, 12}), CommandStatus::kAccepted);
        ASSERT_TRUE(rig.collector.wait_for(12));
        rig.loop.stop();
        for (const auto& frame : rig.collector.frames)
            pictures[static_cast<std::size_t>(prefer)].push_back(frame.dn);
        if (prefer != LoopPreference::kLatency) continue;
        // Exposure's beginnings and ends as the sinks are told of them: begin, end, begin, end.
        const auto& events = rig.collector.events;
        ASSERT_GE(events.size(), 24u);
        for (std::size_t i = 0; i < 24; ++i) {
            EXPECT_EQ(events[i].frame, 1 + i / 2);
            EXPECT_EQ(events[i].kind == CameraEvent::Kind::kExposureStart, i % 2 == 0) << i;
        }
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

TEST_F(GovernedLoopTest, InLockstepTheGovernorIsOff) {
    const auto file = scenario("", "mode: lockstep\nloop: {frame_budget_ms: 0.001}\n");
    const ScenarioConfig config = load_scenario(file, {});
    EXPECT_TRUE(lower_levels(config).empty());
    EXPECT_NE(governor_off(config).find("lockstep"), std::string::npos);
    LoopRig rig(file, {.governor = {0.001, 3}});
    rig.loop.start();
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(rig.send(ExposeCommand{{}, 0}), CommandStatus::kAccepted);
        ASSERT_TRUE(rig.collector.wait_for(static_cast<std::size_t>(i + 1)));
        EXPECT_EQ(rig.collector.frames.back().record.quality_level, 0u);
    }
}

}  // namespace
}  // namespace hilcam
