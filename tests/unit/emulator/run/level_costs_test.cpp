#include "emulator/run/level_costs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <vector>

#include "emulator/run/emulator.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

// Frames of levels that take what a list says; counts how many were made.
struct Machine {
    std::vector<double> render_ms;
    std::vector<int> made = std::vector<int>(render_ms.size());

    std::vector<LevelCost> measure(double enough_ms, std::vector<double> rays = {}) {
        rays.resize(render_ms.size());
        return measure_levels(rays, enough_ms, {}, [this](std::size_t level) {
            ++made[level];
            // The first frame of a level takes longer.
            const double ms = render_ms[level] * (made[level] == 1 ? 1.5 : 1);
            return TrialCost{ms, 1, ms};
        });
    }
};

TEST(LevelCosts, AreMeasuredDownToTheFirstLevelThatSuffices) {
    Machine machine{{100, 50, 20, 10}};
    const std::vector<LevelCost> costs = machine.measure(25);
    ASSERT_EQ(costs.size(), 4u);
    EXPECT_DOUBLE_EQ(costs[0].frame_ms, 100);
    EXPECT_DOUBLE_EQ(costs[1].frame_ms, 50);
    EXPECT_DOUBLE_EQ(costs[2].frame_ms, 20);
    EXPECT_DOUBLE_EQ(costs[2].core_ms, 20);
    EXPECT_DOUBLE_EQ(costs[3].frame_ms, 0);
    EXPECT_EQ(machine.made, (std::vector<int>{2, 2, 2, 0}));
    // A machine that holds the rate is asked for the best level alone.
    Machine fast{{10, 5}};
    EXPECT_DOUBLE_EQ(fast.measure(25)[0].frame_ms, 10);
    EXPECT_EQ(fast.made, (std::vector<int>{2, 0}));
}

TEST(LevelCosts, WhatTakesLongIsMadeOnceAndWhatTakesMinutesNotAtAll) {
    Machine machine{{1e6, 2000, 20}};
    const std::vector<LevelCost> costs = machine.measure(25, {2 * kMaxTrialRays, 1, 1});
    EXPECT_TRUE(std::isinf(costs[0].frame_ms));
    EXPECT_DOUBLE_EQ(costs[1].frame_ms, 3000);
    EXPECT_DOUBLE_EQ(costs[2].frame_ms, 20);
    EXPECT_EQ(machine.made, (std::vector<int>{0, 1, 2}));
}

TEST(LevelCosts, AFrameKeepsTheNextOneWaitingByItsLongerStageOrByTheThreadsThatBothShare) {
    using enum LoopPreference;
    EXPECT_DOUBLE_EQ(frame_ms({20, 10, 24}, {2, 1, kThroughput}), 20);
    EXPECT_DOUBLE_EQ(frame_ms({20, 10, 60}, {2, 1, kThroughput}), 30);
    EXPECT_DOUBLE_EQ(frame_ms({5, 10, 15}, {2, 1, kThroughput}), 10);
    EXPECT_DOUBLE_EQ(frame_ms({20, 10, 60}, {2, 1, kLatency}), 30);
    EXPECT_DOUBLE_EQ(frame_ms({20, 10, 60}, {2, 3, kThroughput}), 90);
}

class LevelCostsOfACamera : public PlateTest {
  protected:
    static std::string content(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::vector<LevelCost> costs(const std::string& loop, const RunLimits& limits = quiet()) {
        ScenarioConfig s = load_scenario(scenario(", frame_rate_hz: 100", loop), {});
        s.loop.holds_rate = true;
        CameraStation station(s, 1, limits);
        station.load(SpectralGrid(s.spectrum_edges_um));
        return station.level_costs();
    }
    static RunLimits quiet() {
        RunLimits limits;
        limits.outputs = false;
        return limits;
    }
};

TEST_F(LevelCostsOfACamera, AreMeasuredWhereAGovernorRunsAndNowhereElse) {
    // No frame is done in a microsecond.
    const std::vector<LevelCost> slow =
        costs("loop: {frame_budget_ms: 0.001, levels: [{max_depth: 1}, {path_model: direct}]}\n");
    ASSERT_EQ(slow.size(), 3u);
    for (const LevelCost& cost : slow) {
        EXPECT_GT(cost.frame_ms, 0);
        EXPECT_GT(cost.core_ms, 0);
    }
    EXPECT_EQ(costs("loop: {frame_budget_ms: 1000000, levels: [{max_depth: 1}]}\n")[1].frame_ms, 0);
    EXPECT_FALSE(costs("loop: {levels: [{max_depth: 1}]}\n").empty());  // auto
    EXPECT_TRUE(costs("loop: {levels: fixed}\n").empty());
    EXPECT_TRUE(costs("loop: {frame_budget_ms: 0}\n").empty());
    EXPECT_TRUE(costs("mode: lockstep\n").empty());
    RunLimits unpaced = quiet();
    unpaced.paced = false;
    EXPECT_TRUE(costs("", unpaced).empty());
}

// The frames that were made to measure leave nothing behind: those of a run are the same with and without.
TEST_F(LevelCostsOfACamera, MeasuringThemChangesNoFrame) {
    const auto pictures_of = [this](const std::string& budget_ms) {
        const ScenarioConfig s = load_scenario(
            scenario(", frame_rate_hz: 4, jitter: {psd: [[1, 100], [50, 1]]}",
                     "seed: 7\nclock: {paused: true}\nquality: {motion: exact, samples_per_axis: 2}\n"
                     "loop: {frame_budget_ms: " +
                         budget_ms + ", levels: [{max_depth: 1}, {path_model: direct}]}\n" +
                         "outputs: {files: {folder: " + (folder_ / budget_ms).string() + ", format: raw}}\n"),
            {});
        RunLimits limits;
        limits.frames = 4;
        Emulator emulator(s, limits);
        EXPECT_EQ(emulator.first().level_costs().empty(), budget_ms == "0");
        emulator.run([] {});
        std::map<std::string, std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / budget_ms))
            if (entry.path().extension() == ".raw") out[entry.path().filename()] = content(entry.path());
        return out;
    };
    const auto without = pictures_of("0"), with = pictures_of("1000000");
    std::size_t compared = 0;
    for (const auto& [name, bytes] : without) {
        const auto other = with.find(name);
        if (other == with.end()) continue;  // a machine with much to do misses exposures
        EXPECT_TRUE(bytes == other->second) << name;
        ++compared;
    }
    EXPECT_GE(compared, 1u);
}

}  // namespace
}  // namespace hilcam
