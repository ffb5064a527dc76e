// Truth beside the frames that it is about.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "emulator/recording/program_version.h"
#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "sensor/published_frame.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using nlohmann::json;

class TruthTest : public PlateTest {
  protected:
    std::vector<json> lines(const std::filesystem::path& file) {
        std::vector<json> out;
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
        // The first says whose they are.
        EXPECT_EQ(out.at(0).at("run").at("program").get<std::string>(), kProgramVersion);
        out.erase(out.begin());
        return out;
    }
};

// Six frames in lockstep, the camera 10 mm farther to the right in each.
std::vector<Collector::Frame> fly(const std::filesystem::path& file,
                                  const std::vector<std::string>& overrides) {
    LoopRig rig(file, {}, overrides);
    rig.loop.start();
    for (int i = 0; i < 6; ++i) {
        PoseCommand pose;
        pose.motion.time = rig.start + (i + 1) * 100'000'000;
        pose.motion.pose.position_world_m = {0.01 * i, 0, 0};
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        EXPECT_EQ(rig.send(ExposeCommand{pose.motion.time, 0}), CommandStatus::kAccepted);
    }
    EXPECT_TRUE(rig.collector.wait_for(6));
    rig.loop.stop();
    if (rig.truth) {
        rig.truth->stop();
        EXPECT_EQ(rig.truth->report().frames, 6u);
        EXPECT_EQ(rig.truth->report().dropped, 0u);
        EXPECT_EQ(rig.truth->report().fault, "");
    }
    return std::move(rig.collector.frames);
}

TEST_F(TruthTest, LockstepFramesAreTheSameWithItAndItIsTheirs) {
    const auto file = scenario();
    for (const std::string motion : {"off", "fast", "exact"}) {
        const std::string quality = "quality.motion=" + motion;
        const auto folder = folder_ / motion;
        const auto without = fly(file, {"mode=lockstep", quality});
        const auto with = fly(file, {"mode=lockstep", quality, "outputs.truth.folder=" + folder.string(),
                                     "outputs.truth.layers=[object, depth]"});
        ASSERT_EQ(without.size(), 6u);
        ASSERT_EQ(with.size(), 6u);
        const std::vector<json> truth = lines(folder / "truth.jsonl");
        ASSERT_EQ(truth.size(), 6u);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(with[i].dn, without[i].dn) << motion << " " << i;
            const json& t = truth[i];
            EXPECT_EQ(t["frame"].get<std::size_t>(), i + 1);
            EXPECT_EQ(t["time_tai_ns"].get<std::int64_t>(), with[i].record.exposure_mid.ns);
            EXPECT_EQ(t["pose_sequence"].get<std::uint32_t>(), with[i].record.pose_sequence);
            EXPECT_EQ(t["image"]["width_px"].get<int>(), 64);
            ASSERT_EQ(t["objects"].size(), 1u);
            const json& plate = t["objects"][0];
            EXPECT_EQ(plate["name"].get<std::string>(), "plate");
            // 10 mm at 4 m and 640 px of focal length.
            EXPECT_NEAR(plate["center_px"][0].get<double>(), 32 - 1.6 * static_cast<double>(i), 1e-6);
            EXPECT_NEAR(plate["center_px"][1].get<double>(), 32, 1e-6);
            EXPECT_NEAR(plate["position_camera_m"][2].get<double>(), 4, 1e-12);
            EXPECT_EQ(plate["visible_fraction"].get<double>(), 1);
            EXPECT_TRUE(std::filesystem::exists(folder / ("truth_0000000" + std::to_string(i + 1) + ".exr")));
        }
    }
}

TEST_F(TruthTest, EveryNthIsOfEveryNth) {
    const auto folder = folder_ / "truth";
    LoopRig rig(scenario(), {},
                {"mode=lockstep", "outputs.truth.folder=" + folder.string(), "outputs.truth.every_nth=3"});
    rig.loop.start();
    EXPECT_EQ(rig.send(ExposeCommand{rig.start + 1'000'000'000, 7}), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(7));
    rig.loop.stop();
    rig.truth->stop();
    const std::vector<json> truth = lines(folder / "truth.jsonl");
    ASSERT_EQ(truth.size(), 3u);
    EXPECT_EQ(truth[0]["frame"].get<int>(), 1);
    EXPECT_EQ(truth[1]["frame"].get<int>(), 4);
    EXPECT_EQ(truth[2]["frame"].get<int>(), 7);
}

TEST_F(TruthTest, MirrorAndBinningAreThoseOfTheFrame) {
    const auto folder = folder_ / "truth";
    LoopRig rig(scenario(", black_columns: 8"), {},
                {"mode=lockstep", "outputs.truth.folder=" + folder.string()});
    EXPECT_TRUE(rig.settings.change({.reverse_x = true}));
    EXPECT_TRUE(rig.settings.change({.binning_x = 2, .binning_y = 2}));
    rig.loop.start();
    PoseCommand pose;
    pose.motion.time = rig.start + 1'000'000'000;
    pose.motion.pose.position_world_m = {0.05, 0, 0};  // the plate goes 8 px to the left
    EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{pose.motion.time, 1}), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(1));
    rig.loop.stop();
    rig.truth->stop();
    const Collector::Frame& frame = rig.collector.frames.at(0);
    EXPECT_EQ(frame.width, 36);
    // The light's middle; a quarter of the plate's light above noise and black level tells what it is.
    double light = 0, x_sum = 0;
    const double most = *std::max_element(frame.dn.begin(), frame.dn.end());
    for (std::size_t i = 0; i < frame.dn.size(); ++i) {
        const double dn = frame.dn[i] > most / 4 ? frame.dn[i] : 0;
        light += dn, x_sum += dn * (static_cast<double>(i % 36) + 0.5);
    }
    const json t = lines(folder / "truth.jsonl").at(0);
    EXPECT_EQ(t["image"]["width_px"].get<int>(), 36);
    EXPECT_EQ(t["image"]["reverse"].dump(), "[true,false]");
    // 24 px of the window are 32 of the array, 16 binned, 20 from the other side.
    const json& plate = t["objects"][0];
    EXPECT_NEAR(plate["center_px"][0].get<double>(), 20, 1e-6);
    EXPECT_NEAR(x_sum / light, 20, 0.2);
    // Its 16 px are 8, on both sides of the middle.
    EXPECT_EQ(plate["visible_box_px"].dump(), "[16,12,8,8]");
}

// Light is a Gaussian of 0.8 px there, so that centroid and sum over a small window are closed: what sampling
// by pixels adds to a centroid is exp(-2 pi^2 0.64) of a pixel, 3e-6, and the table of the point spread
// function 1e-3 at most.
TEST_F(TruthTest, StarsAreWhereTheirLightIs) {
    write("stars.csv",
          "hd,ra_deg,dec_deg,pm_ra_mas_yr,pm_dec_mas_yr,v_mag,b_v\n"
          "11,30,88.0,0,0,1,0.5\n22,200,88.4,0,0,2,0.5\n33,30,60,0,0,2,0.5\n");
    const auto file = write(
        "sky.yaml",
        "time_utc: 2026-12-21T00:00:00Z\n"
        "camera: {name: sky, width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 6.4, f_number: 2,\n"
        "  quantum_efficiency: 0.5, full_well_e: 1000000, gain_dn_e: 0.01, bits: 12, exposure_ms: 5000,\n"
        "  distortion: [-0.3, 0.1, 0.01, -0.02], black_columns: 5, black_rows: 3, diffusion_um: 8,\n"
        "  measured_mtf: {mtf: [[0, 1], [100000, 1]]}}\n"
        "earth: {visible: false}\nmoon: {visible: false}\n"
        "stars: {catalogue: stars.csv}\nspectrum_edges_um: [0.5, 0.7]\n");
    const ScenarioConfig s = load_scenario(file, {});
    StillCamera camera(s);
    FrameTruth t = make_truth(s, camera.renderer(), truth_request(s));
    t.raster = raster_of(s.camera, 1, {});
    camera.render({1, 1}, &t);
    const ElectronImage& light = camera.expose();
    ASSERT_EQ(t.stars.size(), 2u);
    EXPECT_EQ(t.stars[0].hd, 11u);
    EXPECT_EQ(t.stars[1].hd, 22u);
    EXPECT_EQ(t.stars[1].row, 1u);
    const TruthDocument document(truth_source(s, camera.grid(), 1, ""));
    FrameRecord record;
    record.exposure_s = 5;
    const json told = json::parse(document.line(t, record));
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec2d at = t.stars[i].position_px;
        double sum = 0, x_sum = 0, y_sum = 0;
        for (int y = static_cast<int>(at.y) - 8; y <= static_cast<int>(at.y) + 8; ++y)
            for (int x = static_cast<int>(at.x) - 8; x <= static_cast<int>(at.x) + 8; ++x) {
                const double e = light.row(y)[static_cast<std::size_t>(x)];
                sum += e, x_sum += e * (x + 0.5), y_sum += e * (y + 0.5);
            }
        EXPECT_GT(sum, 1000);
        EXPECT_NEAR(x_sum / sum, at.x, 2e-3) << i;
        EXPECT_NEAR(y_sum / sum, at.y, 2e-3) << i;
        EXPECT_NEAR(told["stars"][i]["electrons"].get<double>() / sum, 1, 1e-3) << i;
        EXPECT_NEAR(told["stars"][i]["position_px"][0].get<double>(), at.x, 1e-6);
    }
}

TEST_F(TruthTest, WhatGoesNowhereAndWhatIsNoLayerIsRefused) {
    const auto file = scenario();
    EXPECT_NE(error_of([&] {
                  load_scenario(file, std::vector<std::string>{"outputs.truth.every_nth=2"});
              }).find("outputs.truth goes nowhere"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  load_scenario(file, std::vector<std::string>{"outputs.truth.folder=x",
                                                               "outputs.truth.layers=[depth, color]"});
              }).find("layers: found 'color'; accepted: object, range"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  load_scenario(file, std::vector<std::string>{"outputs.truth.port=5012",
                                                               "outputs.truth.layers=[depth]"});
              }).find("they need 'folder'"),
              std::string::npos);
}

TEST_F(TruthTest, CamerasDoNotWriteOverEachOthersFiles) {
    const auto file = scenario(
        "",
        "more_cameras:\n  - {camera: {name: second, width_px: 8, height_px: 8, pitch_um: 10, f_number: 8,\n"
        "    focal_length_mm: 4, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12,\n"
        "    exposure_ms: 3}, outputs: {truth: {folder: a/../x}}}\n");
    const auto error_with = [&](const std::string& folder) {
        return error_of(
            [&] { load_scenario(file, std::vector{"outputs.truth.folder=" + (folder_ / folder).string()}); });
    };
    EXPECT_NE(error_with("x").find("outputs.truth.folder: found '"), std::string::npos);
    EXPECT_EQ(error_with("y"), "no error");
}

}  // namespace
}  // namespace hilcam
