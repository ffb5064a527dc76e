// A campaign's file, its cases and the processes that make them.

#include "emulator/campaign/campaign.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <map>
#include <set>

#include "emulator/campaign/campaign_config.h"
#include "emulator/campaign/case_record.h"
#include "emulator/campaign/case_search.h"
#include "emulator/campaign/noise_variance.h"
#include "emulator/campaign/view_draw.h"
#include "emulator/campaign/worker_pool.h"
#include "emulator/tradeoff/image_error.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class CampaignTest : public PlateTest {
  protected:
    CampaignConfig campaign(const std::string& text) {
        scenario();
        return load_campaign(write("campaign.yaml", "name: test\nscenario: scenario.yaml\n" + text));
    }
    std::string refused(const std::string& text) {
        return error_of([&] { campaign(text); });
    }
};

TEST_F(CampaignTest, AMistakeHasOneMessageThatSaysWhereAndWhatIsAccepted) {
    const std::vector<std::pair<std::string, std::string>> mistakes = {
        {"cout: 3\n", "campaign.yaml:3:1: cout: unknown key; nearest known key: count"},
        {"vary: [{key: a, uniform: [0, 1], choice: [2]}]\n",
         "vary.0.key: found 2 distributions for 'a'; accepted: one of"},
        {"vary: [{key: a, uniform: [2, 1]}]\n", "found 2 before 1; accepted: the least, then the most"},
        {"vary: [{key: a, log_uniform: [0, 1]}]\n", "found 0; accepted: numbers above 0"},
        {"vary: [{key: a, value: 1}, {key: a, value: 2}]\n",
         "vary.1.key: found 'a' twice; accepted: each key once"},
        {"vary: [{key: seed, value: 1}]\n", "each case has a seed of its own"},
        {"vary: [{key: camera_pose.up, value: 1}]\nview: {range_m: {value: 3}}\n",
         "accepted: a key that 'view' does not give"},
        {"view: {}\n", "view.size_px: found neither of size_px and range_m; accepted: one of them"},
        {"view: {size_px: {value: 3}, range_m: {value: 2}}\n", "found both of size_px and range_m"},
        {"view: {size_px: {}}\n", "found 0 distributions; accepted: one of value, uniform"},
        {"labels: [cocoa]\n", "labels: found 'cocoa'; accepted: a list of coco, bop, yolo, speed"},
        {"pictures: {layers: [colour]}\n", "found 'colour'; accepted: a list of object, range, depth"},
        {"pictures: {flow: true}\n", "pictures.flow: found true with one picture a case"},
        {"splits: [{name: a, share: 0.5}]\n",
         "splits: found shares of 0.5 in all; accepted: shares of 1 in all"},
        {"splits: [{name: a/b, share: 1}]\n", "splits.0.name: found 'a/b'; accepted: letters"},
        {"camera: 2\nview: {range_m: {value: 3}}\n", "camera: found 2; accepted: 1 with 'view'"},
        {"run: {}\n", "a run without a program needs an end"},
        {"run: {frames: 3}\nlabels: [coco]\n", "runs have no labels"},
    };
    for (const auto& [text, message] : mistakes) {
        const std::string found = refused(text);
        EXPECT_THAT(found, HasSubstr(message)) << text;
        EXPECT_EQ(found.find('\n'), std::string::npos);
    }
    EXPECT_THAT(error_of([&] { load_campaign(scenario()); }),
                HasSubstr("is a scenario; accepted: a campaign"));
}

TEST_F(CampaignTest, ATableGivesACaseEachOfItsRows) {
    write("table.csv", "camera.exposure_ms, objects.0.pose.position_m\n3, \"[0, 0, 5]\"\n4, \"[0, 1, 5]\"\n");
    const CampaignConfig c = campaign("count: 2\ntable: table.csv\n");
    const CasePlan plan = CaseDraw(c).plan(2, 0);
    EXPECT_THAT(plan.overrides, testing::Contains("camera.exposure_ms=4"));
    EXPECT_THAT(plan.overrides, testing::Contains("objects.0.pose.position_m=[0, 1, 5]"));
    const CampaignConfig more = campaign("count: 3\ntable: table.csv\n");
    EXPECT_THAT(error_of([&] { CaseDraw draw(more); }),
                HasSubstr("table.csv: found 2 rows; accepted: one for each of the 3 cases"));
}

// Shares of 10,000 cases by chance: 4.5 standard errors of sqrt(p (1 - p) / n).
TEST_F(CampaignTest, SplitsHaveTheirSharesOfTheCases) {
    const CampaignConfig c = campaign(
        "count: 10000\nsplits: [{name: a, share: 0.7}, {name: b, share: 0.2}, {name: c, share: 0.1}]\n");
    const CaseDraw draw(c);
    std::map<std::string, int> counts;
    for (std::uint64_t n = 1; n <= 10000; ++n) ++counts[draw.plan(n, 0).split];
    for (const auto& [name, share] : {std::pair{"a", 0.7}, {"b", 0.2}, {"c", 0.1}})
        EXPECT_NEAR(counts[name] / 1e4, share, 4.5 * std::sqrt(share * (1 - share) / 1e4));
}

TEST(CampaignKeys, OnlyWhatPlacesAndSetsIsTakenOverWithoutLoading) {
    for (const char* key :
         {"seed", "camera.exposure_ms", "camera_pose", "camera_pose.up", "camera_motion",
          "objects.3.pose.position_m", "objects.0.motion.kepler.node_deg", "objects.0.joints.1.angle_deg"})
        EXPECT_TRUE(is_taken_over(key, false)) << key;
    for (const char* key :
         {"objects.0.mesh", "objects.0.pose.rate_deg_s", "objects.0.pose", "camera.width_px", "quality",
          "stars.catalogue", "time_utc", "objects.0.joints.1.rate_deg_s"})
        EXPECT_FALSE(is_taken_over(key, false)) << key;
    EXPECT_TRUE(is_taken_over("time_utc", true));
}

// The view that was asked for is the one that truth tells of.
TEST_F(CampaignTest, TheCameraStandsWhereTheViewSays) {
    const CampaignConfig c = campaign(
        "count: 20\nseed: 5\nview: {size_px: {uniform: [5, 20]}, phase_deg: {uniform: [10, 150]}, "
        "offset_share: {uniform: [-0.5, 0.5]}}\n");
    const CaseDraw draw(c);
    CaseCamera camera(c);
    for (std::uint64_t n = 1; n <= 20; ++n) {
        const CasePlan plan = find_case(c, draw, n, camera);
        TruthRequest request;
        request.visibility = request.stars = false;
        FrameTruth truth = truth_record(camera, request);
        camera.camera().report(truth);
        const SeenThing& plate = truth.things[0];
        const double size_px = 5 + 15 * draw.view_place(n, 0, CaseDraw::View::kSize);
        const double phase_deg = 10 + 140 * draw.view_place(n, 0, CaseDraw::View::kPhase);
        // The lens's focal length is 640 px.
        EXPECT_NEAR(2 * 640 * std::tan(std::asin(plate.radius_m / plate.distance_m)), size_px, 1e-6);
        EXPECT_NEAR(plate.phase_rad / kDegree_rad, phase_deg, 1e-6);
        const auto at = [&](CaseDraw::View d) { return 32 * (1 + draw.view_place(n, 0, d) - 0.5); };
        EXPECT_NEAR(plate.center_px.x, at(CaseDraw::View::kOffsetX), 1e-6);
        EXPECT_NEAR(plate.center_px.y, at(CaseDraw::View::kOffsetY), 1e-6);
    }
    EXPECT_EQ(camera.loads(), 1);
}

TEST_F(CampaignTest, WhatCannotBeStopsAndSaysWhatWasTried) {
    const CampaignConfig c = campaign(
        "view: {size_px: {value: 10}, phase_deg: {value: 175}}\nrequire: {lit_share: 0.99, tries: 7}\n");
    const CaseDraw draw(c);
    CaseCamera camera(c);
    EXPECT_THAT(
        error_of([&] { find_case(c, draw, 1, camera); }),
        testing::AllOf(
            HasSubstr("none of 7 tries is what is asked for: require.lit_share was not met by 7 (at best "),
            HasSubstr("accepted: wider draws, less in 'require', or more tries")));
}

// What a case is does not depend on the cases before it, nor on what was loaded for them.
TEST_F(CampaignTest, ACaseIsTheSameAfterOthersAsAlone) {
    const CampaignConfig c = campaign(
        "count: 6\nview: {size_px: {uniform: [5, 40]}}\nvary: [{key: camera.exposure_ms, log_uniform: [1, "
        "50]}, "
        "{key: quality.oversampling, choice: [1, 2]}]\n");
    const CaseDraw draw(c);
    const auto picture = [&](CaseCamera& camera, std::uint64_t n) {
        find_case(c, draw, n, camera);
        const RandomKey key{seed_of_camera(camera.scenario(), 0), 1};
        camera.camera().render(key);
        camera.camera().expose();
        const DnImage& frame = camera.camera().digitise(key);
        return std::vector<std::uint16_t>(frame.all().begin(), frame.all().end());
    };
    CaseCamera all(c);
    std::set<std::vector<std::uint16_t>> different;
    for (std::uint64_t n = 1; n <= 6; ++n) {
        CaseCamera alone(c);
        const auto frame = picture(all, n);
        EXPECT_EQ(frame, picture(alone, n)) << n;
        different.insert(frame);
    }
    EXPECT_EQ(different.size(), 6u);
    EXPECT_GT(all.loads(), 1);
}

// Variances of 100 takings over those that are told, mean over the plate and over the dark: its standard error
// is sqrt(2 / 99 / pixels) of 1, and 5 of these are granted. A variance without the read noise of 5 e- would be a
// third of itself in the dark.
TEST_F(CampaignTest, NoiseVariesAsItsVarianceSays) {
    const ScenarioConfig s = load_scenario(scenario(), {});
    StillCamera camera(s);
    camera.render({1, 1});
    const ElectronImage& mean_e = camera.expose();
    const VarianceImage variance = noise_variance(s.camera, mean_e, camera.exposure());
    const std::size_t pixels = variance.pixels();
    std::vector<double> sum(pixels), squares(pixels);
    constexpr int kTakings = 100;
    for (std::uint64_t n = 1; n <= kTakings; ++n) {
        const DnImage& frame = camera.digitise({7 * n, 1});
        for (std::size_t i = 0; i < pixels; ++i) {
            const double dn = frame.data()[i];
            sum[i] += dn, squares[i] += dn * dn;
        }
    }
    struct Kind {
        double ratios = 0, count = 0;
    } bright, dark;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!(variance.data()[i] > 0)) continue;
        const double measured = (squares[i] - sum[i] * sum[i] / kTakings) / (kTakings - 1);
        Kind& kind = mean_e.data()[i] > 500 ? bright : dark;
        kind.ratios += measured / static_cast<double>(variance.data()[i]), ++kind.count;
    }
    for (const Kind& kind : {bright, dark}) {
        ASSERT_GT(kind.count, 100);
        EXPECT_NEAR(kind.ratios / kind.count, 1, 5 * std::sqrt(2.0 / 99 / kind.count));
    }
}

// Two plates at a right angle light each other by random paths. Sums of variances over all bright pixels, of
// 120 takings with other paths and other noise, and as told by 16 renderings: the latter's own error is
// sqrt(2 / 15) of each pixel's rendering noise, that of the former sqrt(2 / 119) of all; the lens spreads a
// pixel's paths over its neighbours, so a ninth of the pixels are taken for independent. 5 standard errors.
TEST_F(CampaignTest, NoiseOfRandomPathsIsInItsVariance) {
    const std::filesystem::path file = scenario();
    write("plate.obj",
          "v -0.05 -0.05 -0.05\nv 0 -0.05 0\nv 0 0.05 0\nv -0.05 0.05 -0.05\nv 0.05 -0.05 -0.05\n"
          "v 0.05 0.05 -0.05\nf 1 3 2\nf 1 4 3\nf 2 6 5\nf 2 3 6\n");
    const ScenarioConfig s = load_scenario(file, std::vector<std::string>{"quality.path_model=path"});
    StillCamera camera(s);
    RenderingNoise noise;
    for (std::uint64_t n = 1; n <= RenderingNoise::kRenderings; ++n) {
        camera.render({1000 + n, 1});
        noise.add(camera.expose(), s.camera, camera.exposure());
    }
    camera.render({1, 1});
    const ElectronImage mean_e = clone(camera.expose());
    const VarianceImage told = noise_variance(s.camera, mean_e, camera.exposure(), noise.variance_e2());
    const VarianceImage sensor = noise_variance(s.camera, mean_e, camera.exposure());
    const std::size_t pixels = told.pixels();
    std::vector<double> sum(pixels), squares(pixels);
    constexpr int kTakings = 120;
    for (std::uint64_t n = 1; n <= kTakings; ++n) {
        camera.render({7 * n, 1});
        camera.expose();
        const DnImage& frame = camera.digitise({7 * n, 1});
        for (std::size_t i = 0; i < pixels; ++i) {
            const double dn = frame.data()[i];
            sum[i] += dn, squares[i] += dn * dn;
        }
    }
    double measured_dn2 = 0, told_dn2 = 0, sensor_dn2 = 0, count = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!(mean_e.data()[i] > 500) || !(told.data()[i] > 0)) continue;
        measured_dn2 += (squares[i] - sum[i] * sum[i] / kTakings) / (kTakings - 1);
        told_dn2 += static_cast<double>(told.data()[i]), sensor_dn2 += static_cast<double>(sensor.data()[i]);
        ++count;
    }
    ASSERT_GT(count, 100);
    const double rendering_share = 1 - sensor_dn2 / told_dn2;
    const double error = std::sqrt((2.0 / 119 + 2.0 / 15 * rendering_share * rendering_share) / (count / 9));
    RecordProperty("rendering_share", std::to_string(rendering_share));
    EXPECT_NEAR(measured_dn2 / told_dn2, 1, 5 * error);
    EXPECT_GT(measured_dn2 / sensor_dn2, 1 + 5 * error) << "the sensor's noise alone is too little";
}

// Where no path is drawn, two renderings are the same.
TEST_F(CampaignTest, RenderingWithoutRandomPathsHasNoVariance) {
    const ScenarioConfig s = load_scenario(scenario(), std::vector<std::string>{"quality.path_model=direct"});
    StillCamera camera(s);
    RenderingNoise noise;
    EXPECT_TRUE(noise.variance_e2().empty());
    for (std::uint64_t n = 1; n <= 2; ++n) {
        camera.render({1000 + n, 1});
        noise.add(camera.expose(), s.camera, camera.exposure());
    }
    for (const double v : noise.variance_e2()) ASSERT_EQ(v, 0);
}

// One sheet serves all cases of a camera, and no case has that of another's.
TEST_F(CampaignTest, ACasesSheetIsThatOfItsCamera) {
    CaseCamera camera(campaign("seed: 1\n"));
    const double own_e = camera.sheet().dark_total_e;
    camera.take({"objects.0.scale=2", "camera.exposure_ms=40", "seed=3"});
    EXPECT_EQ(camera.loads(), 2);
    EXPECT_EQ(camera.sheet().dark_total_e, own_e);
    camera.take({"camera.read_noise_e=50", "seed=3"});
    EXPECT_GT(camera.sheet().dark_total_e, 5 * own_e);
    camera.take({"seed=3"});
    EXPECT_EQ(camera.sheet().dark_total_e, own_e);
}

// A case is missing without a record, with one that is damaged, and when a file of it is gone or another.
TEST_F(CampaignTest, ACaseThatHasLostAFileIsMissing) {
    const CampaignConfig c = campaign("count: 6\n");
    const std::filesystem::path out = folder_ / "out";
    const CampaignFolder folder(c, out, false);
    std::filesystem::create_directories(out / "images");
    for (std::uint64_t n = 1; n <= 5; ++n) {
        CaseRecord record;
        record.plan.number = n, record.plan.name = case_name(n);
        record.done = n != 5;
        record.files = {{"images/" + case_name(n) + ".png", 5}};
        write("out/images/" + case_name(n) + ".png", "12345");
        write_record(out, record);
    }
    EXPECT_THAT(folder.missing({1, 6}, false), testing::ElementsAre(6u));
    EXPECT_THAT(folder.missing({1, 6}, true), testing::ElementsAre(5u, 6u));
    std::filesystem::remove(out / "images/000001.png");
    write("out/images/000002.png", "");
    write("out/cases/000003.json", "{");
    EXPECT_THAT(folder.missing({1, 6}, false), testing::ElementsAre(1u, 2u, 3u, 6u));
    EXPECT_EQ(lost_file(out, *read_record(out, 1)), "images/000001.png is missing");
    EXPECT_EQ(lost_file(out, *read_record(out, 2)), "images/000002.png has 0 bytes of 5");
    EXPECT_EQ(lost_file(out, *read_record(out, 4)), "");
}

// What is made of a mesh serves it in all sizes; what no other case has is not worth keeping.
TEST_F(CampaignTest, ShapesOfOneCaseAreTold) {
    const auto own = [&](const std::string& vary) {
        return draws_own_shapes(campaign("vary: [{key: " + vary + "}]\n"));
    };
    EXPECT_FALSE(own("objects.0.scale, uniform: [1, 2]"));
    EXPECT_FALSE(own("objects.0.pose.position_m, sphere: [1, 2]"));
    EXPECT_FALSE(own("objects.0.joints.0.angle_deg, uniform: [1, 2]"));
    EXPECT_FALSE(own("camera.focal_length_mm, uniform: [1, 2]"));
    EXPECT_FALSE(own("objects.0.mesh, choice: [a.obj, b.obj]"));
    EXPECT_TRUE(own("objects.0.generate.wing_angle_deg, uniform: [1, 2]"));
    EXPECT_TRUE(own("objects.0.generate.seed, whole: [1, 1000]"));
    EXPECT_TRUE(own("atmosphere.ozone_du, normal: [300, 20]"));
    write("table.csv", "objects.0.mesh\na.obj\n");
    EXPECT_TRUE(draws_own_shapes(campaign("table: table.csv\n")));
}

TEST_F(CampaignTest, TwoCampaignsDoNotShareAFolder) {
    const CampaignConfig c = campaign("seed: 1\n");
    const std::filesystem::path out = folder_ / "out";
    { const CampaignFolder first(c, out, false); }
    { const CampaignFolder again(c, out, false); }
    CampaignConfig more = c;
    more.count = 500;
    { const CampaignFolder longer(more, out, false); }
    CampaignConfig other = c;
    other.seed = 2;
    EXPECT_THAT(error_of([&] { CampaignFolder f(other, out, false); }),
                HasSubstr("holds another campaign (seed: '1' there, '2' here)"));
    const CampaignFolder holder(c, out, false);
    EXPECT_THAT(error_of([&] { CampaignFolder f(c, out, false); }),
                HasSubstr("another process is working on this campaign"));
    std::filesystem::create_directories(folder_ / "used");
    write("used/file", "x");
    EXPECT_THAT(error_of([&] { CampaignFolder f(c, folder_ / "used", false); }),
                HasSubstr("is not empty and holds no campaign"));
}

TEST(WorkerPool, APieceThatCrashesOrHangsIsLostAloneAndNamed) {
    WorkerPool pool(2, 0.5, [](std::size_t) -> WorkerPool::Work {
        return [](std::uint64_t n) -> std::string {
            if (n == 3) std::raise(SIGSEGV);
            if (n == 5) pause();
            if (n == 6) _exit(7);
            if (n == 7) std::raise(SIGKILL);
            return n == 8 ? "does not like it" : "";
        };
    });
    std::map<std::uint64_t, std::string> problems;
    std::set<std::uint64_t> crashed, ended;
    pool.run({1, 2, 3, 4, 5, 6, 7, 8, 9},
             [&](std::uint64_t n, const std::string& problem, WorkerPool::End end) {
                 EXPECT_TRUE(problems.emplace(n, problem).second);
                 if (end == WorkerPool::End::kCrashed) crashed.insert(n);
                 if (end == WorkerPool::End::kWasEnded) ended.insert(n);
             });
    EXPECT_EQ(problems.size(), 9u);
    EXPECT_EQ(crashed, (std::set<std::uint64_t>{3, 5, 6}));
    EXPECT_EQ(ended, (std::set<std::uint64_t>{7}));
    EXPECT_THAT(problems[7], HasSubstr("was ended: signal 9"));
    EXPECT_THAT(problems[3], HasSubstr("crashed: signal 11"));
    EXPECT_THAT(problems[5], HasSubstr("took longer than 0 s (time_limit_s)"));
    EXPECT_THAT(problems[6], HasSubstr("ended with status 7"));
    EXPECT_EQ(problems[8], "does not like it");
    EXPECT_EQ(problems[9], "");
}

// Children that ignore being asked are ended all the same; what they were at is told to nobody.
TEST(WorkerPool, StopsWhenItIsAskedTo) {
    WorkerPool pool(3, 600, [](std::size_t) -> WorkerPool::Work {
        return [](std::uint64_t n) -> std::string {
            if (n == 2) std::signal(SIGTERM, SIG_IGN);
            while (n > 1) pause();
            return "";
        };
    });
    std::vector<std::uint64_t> told;
    pool.run(
        {1, 2, 3, 4, 5}, [&](std::uint64_t n, const std::string&, WorkerPool::End) { told.push_back(n); },
        [&] { return !told.empty(); });
    EXPECT_THAT(told, testing::ElementsAre(1u));
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

TEST(WorkerPool, AChildThatCannotBeginEndsAll) {
    WorkerPool pool(2, 10, [](std::size_t) -> WorkerPool::Work { throw InputError("no mesh"); });
    try {
        pool.run({1, 2, 3}, [](std::uint64_t, const std::string&, WorkerPool::End) { ADD_FAILURE(); });
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "no mesh");
    }
}

}  // namespace
}  // namespace hilcam
