// Tables of directions that are made beside a run, as the emulator's parts see it; tests/closed_form has the
// frames, tests/realtime the loop, tests/protocol/light_test.py the program.

#include "emulator/run/light_maker.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "emulator/run/camera_station.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// Two cubes of one make before the camera, with an empty cache folder.
class LightBeside : public FilesTest {
  protected:
    void SetUp() override {
        FilesTest::SetUp();
        if (const char* cache = std::getenv("HILCAM_CACHE")) before_ = cache;
        setenv("HILCAM_CACHE", (folder_ / "cache").c_str(), 1);
        write("cube.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
              "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    }
    void TearDown() override {
        if (before_.empty())
            unsetenv("HILCAM_CACHE");
        else
            setenv("HILCAM_CACHE", before_.c_str(), 1);
        FilesTest::TearDown();
    }
    ScenarioConfig scenario(const std::vector<std::string>& overrides = {}, int nodes = 2000) {
        const std::string mesh = "mesh: " + (folder_ / "cube.obj").string();
        std::vector<std::string> all = {
            "quality.path_model=cached", "quality.probes=" + std::to_string(nodes),
            "objects=[{name: a, " + mesh + "}, {name: b, " + mesh + ", pose: {position_m: [3, 0, 0]}}]"};
        all.insert(all.end(), overrides.begin(), overrides.end());
        return load_scenario(std::string(HILCAM_SOURCE_DIR) + "/tests/protocol/minimal_scenario.yaml", all);
    }
    static std::unique_ptr<CameraStation> loaded(const ScenarioConfig& s, const RunLimits& limits) {
        auto station = std::make_unique<CameraStation>(s, 1, limits);
        station->load(SpectralGrid(s.spectrum_edges_um));
        return station;
    }
    bool has_table() const {
        if (!std::filesystem::exists(folder_ / "cache")) return false;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
            if (entry.path().filename().string().starts_with("transfer_")) return true;
        return false;
    }
    static constexpr auto kBeside = [] {
        RunLimits limits;
        limits.outputs = false, limits.light_beside = true;
        return limits;
    };

  private:
    std::string before_;
};

TEST_F(LightBeside, OneTableIsOrderedForAllOfAMake) {
    const auto station = loaded(scenario(), kBeside());
    ASSERT_EQ(station->light().orders.size(), 1u);
    const TableOrder& order = station->light().orders.front();
    EXPECT_EQ(order.name, "a");
    EXPECT_THAT(order.objects, testing::ElementsAre(0u, 1u));
    EXPECT_EQ(order.mesh.triangles.size(), 12u);
    EXPECT_FALSE(has_table());
    EXPECT_FALSE(station->renderer().take_light());
}

TEST_F(LightBeside, WhoMustNotBeginWithoutWaits) {
    RunLimits plain = kBeside(), record = kBeside(), replay = kBeside();
    plain.light_beside = false;
    record.record = folder_ / "a.rec";
    replay.replay = folder_ / "a.rec";
    const auto waits = [&](const ScenarioConfig& s, const RunLimits& limits) {
        std::filesystem::remove_all(folder_ / "cache");
        const auto station = loaded(s, limits);
        return station->light().orders.empty() && station->light().made == 1 && has_table() &&
               station->renderer().take_light();
    };
    EXPECT_TRUE(waits(scenario(), plain));
    EXPECT_TRUE(waits(scenario(), record));
    EXPECT_TRUE(waits(scenario(), replay));
    EXPECT_TRUE(waits(scenario({"mode=lockstep"}), kBeside()));
    EXPECT_TRUE(waits(scenario({"loop.wait_for_light=true"}), kBeside()));
    EXPECT_FALSE(waits(scenario({"mode=triggered"}), kBeside()));
}

TEST_F(LightBeside, WhatIsOnDiskIsNotMadeAgain) {
    loaded(scenario(), {.outputs = false});
    const auto station = loaded(scenario(), kBeside());
    EXPECT_EQ(station->light().found, 1u);
    EXPECT_EQ(station->light().made, 0u);
    EXPECT_TRUE(station->light().orders.empty());
    EXPECT_TRUE(station->renderer().take_light());
}

TEST_F(LightBeside, ItIsMadeWrittenAndGiven) {
    const auto station = loaded(scenario(), kBeside());
    LightMaker maker({{&station->renderer(), std::move(station->light().orders)}});
    EXPECT_EQ(maker.share(), 0);
    maker.start();
    for (int i = 0; i < 60'000 && !maker.is_done(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(maker.is_done());
    EXPECT_EQ(maker.share(), 1);
    EXPECT_GT(maker.seconds(), 0);
    EXPECT_TRUE(has_table());
}

// A million places are the work of many seconds.
TEST_F(LightBeside, ARunThatEndsGivesUpWhatIsNotMade) {
    const auto station = loaded(scenario({}, 1'000'000), kBeside());
    LightMaker maker({{&station->renderer(), std::move(station->light().orders)}});
    maker.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    maker.stop();
    EXPECT_FALSE(maker.is_done());
    EXPECT_LT(maker.share(), 1);
    EXPECT_FALSE(has_table());
}

}  // namespace
}  // namespace hilcam
