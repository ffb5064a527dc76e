#include "emulator/recording/run_seed.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emulator/check/check_command.h"
#include "emulator/run/report.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr std::size_t kRunFrames = 16, kPixels = 64 * 64;
using Frames = std::array<std::array<double, kPixels>, kRunFrames>;

// A camera whose pixels differ, before a plate that fills its view.
class RunSeedTest : public PlateTest {
  protected:
    ScenarioConfig bench(const std::string& folder, const std::vector<std::string>& more = {}) {
        const auto file =
            scenario(", dsnu_e: 5, prnu_fraction: 0.01",
                     "mode: lockstep\n"
                     "outputs: {files: {folder: unused, format: raw}}\n"
                     "events: [{at_s: 0.5, every_s: 0.5, times: 16, do: expose}, {at_s: 9, do: end}]\n");
        std::vector<std::string> overrides = {"outputs.files.folder=" + (folder_ / folder).string(),
                                              "objects.0.pose.position_m=[0, 0, 0.5]"};
        overrides.insert(overrides.end(), more.begin(), more.end());
        return load_scenario(file, overrides);
    }
    // Runs the bench with its seed settled as `hilcam run` settles it.
    Frames run(const std::string& folder, const std::vector<std::string>& more, RunLimits limits = {}) {
        ScenarioConfig scenario = bench(folder, more);
        settle_seed(scenario, limits.replay);
        limits.seconds = 60;
        Emulator emulator(scenario, limits);
        emulator.run([] {});
        EXPECT_EQ(run_report(emulator)["seed"], scenario.seed);
        return frames_in(folder);
    }
    Frames frames_in(const std::string& folder) const {
        Frames out{};
        for (std::size_t i = 0; i < kRunFrames; ++i) {
            char name[32];
            std::snprintf(name, sizeof name, "frame_%08zu.raw", i + 1);
            std::ifstream in(folder_ / folder / name, std::ios::binary);
            std::array<std::uint16_t, kPixels> dn{};
            in.read(reinterpret_cast<char*>(dn.data()), sizeof dn);
            EXPECT_TRUE(in) << folder << "/" << name;
            for (std::size_t p = 0; p < kPixels; ++p) out[i][p] = dn[p];
        }
        return out;
    }
};

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<double>(a.size());
    double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) mean_a += a[i] / n, mean_b += b[i] / n;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

std::vector<double> pattern(const Frames& frames) {
    std::vector<double> mean(kPixels);
    for (const auto& frame : frames)
        for (std::size_t p = 0; p < kPixels; ++p) mean[p] += frame[p] / kRunFrames;
    return mean;
}

// What changes from frame to frame: differences of neighbours, so that no pattern is in them.
std::vector<double> noise(const Frames& frames) {
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < kRunFrames; i += 2)
        for (std::size_t p = 0; p < kPixels; ++p) out.push_back(frames[i + 1][p] - frames[i][p]);
    return out;
}

const std::vector<std::string> kDark = {"camera.exposure_ms=0.001"}, kLight = {"camera.exposure_ms=0.5"};

std::vector<std::string> with_seed(std::vector<std::string> overrides, int seed) {
    overrides.push_back("seed=" + std::to_string(seed));
    return overrides;
}

}  // namespace

// A dark run is taken from a light one to measure a sensor: their noise must not be the same numbers. The
// limit is 4 standard deviations of a correlation of N independent pairs, 1 / sqrt(N).
TEST_F(RunSeedTest, RunsWithoutASeedShareTheirPatternAndNotTheirNoise) {
    const Frames dark = run("dark", kDark), light = run("light", kLight), again = run("again", kDark);
    EXPECT_GT(pattern(light)[2080], pattern(dark)[2080] + 40);
    const double limit = 4 / std::sqrt(static_cast<double>(noise(dark).size()));
    EXPECT_LT(std::abs(correlation(noise(dark), noise(light))), limit);
    EXPECT_LT(std::abs(correlation(noise(dark), noise(again))), limit);
    // The mean of 16 frames has 1.25 e- of noise left beside 5 e- of pattern: correlation 25 / 26.6.
    EXPECT_GT(correlation(pattern(dark), pattern(again)), 0.9);
    // One seed for both is what spoils such a measurement; the pattern is the camera's, whatever the seed.
    const Frames seven = run("seven", with_seed(kDark, 7)), lit = run("lit", with_seed(kLight, 7));
    EXPECT_GT(correlation(noise(seven), noise(lit)), 10 * limit);
    EXPECT_GT(correlation(pattern(dark), pattern(seven)), 0.9);
}

TEST_F(RunSeedTest, RunsOfAStatedSeedAreTheSameBits) {
    EXPECT_EQ(run("one", with_seed(kLight, 7)) == run("two", with_seed(kLight, 7)), true);
}

TEST_F(RunSeedTest, AReplayTakesTheRecordingsSeed) {
    RunLimits recorded, replayed;
    recorded.record = replayed.replay = folder_ / "run.rec";
    const Frames first = run("first", kLight, recorded);
    EXPECT_EQ(run("second", kLight, replayed) == first, true);
    ScenarioConfig other = bench("other", with_seed(kLight, 7));
    EXPECT_EQ(settle_seed(other, replayed.replay), "");
    EXPECT_EQ(other.seed, 7);
    EXPECT_THAT(error_of([&] { Emulator(other, replayed); }), HasSubstr("there, '7' here; --force"));
}

TEST_F(RunSeedTest, IsToldAndRepeatsTheRun) {
    ScenarioConfig scenario = bench("told");
    EXPECT_THAT(to_text(check_scenario(scenario)), HasSubstr("seed: none, so each run draws its own noise"));
    const std::string line = settle_seed(scenario);
    EXPECT_THAT(line, HasSubstr("--set seed=" + std::to_string(scenario.seed)));
    EXPECT_THAT(to_text(check_scenario(scenario)), HasSubstr("every run has the same noise"));
    EXPECT_LE(scenario.seed, 9e15);
    ScenarioConfig next = bench("told");
    settle_seed(next);
    EXPECT_NE(next.seed, scenario.seed);
}

}  // namespace hilcam
