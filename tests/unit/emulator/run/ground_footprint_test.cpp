#include "emulator/run/ground_footprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "emulator/ground/ground_heights.h"
#include "emulator/run/still_camera.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/scene_loader.h"
#include "render/ground/crater_profile.h"
#include "render/vocabulary/check.h"
#include "sensor/published_frame.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// The landing example's scene from straight above its site, with other ground where a test asks for it.
ScenarioConfig above_the_site(double height_m, std::vector<std::string> more = {}) {
    std::vector<std::string> overrides = {"terrain.edge_px=1.5", "terrain.max_triangles=600000",
                                          "camera.width_px=320", "camera.height_px=256",
                                          "camera_pose.position_m=[0, 0, " + std::to_string(height_m) + "]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scenario(HILCAM_SOURCE_DIR "/tools/landing_example/landing.yaml", overrides);
}

using Rows = std::vector<std::vector<double>>;
enum Column : std::size_t {
    kLongitude,
    kLatitude,
    kEast,
    kNorth,
    kDiameter,
    kFigure,
    kX,
    kY,
    kDiameterPx,
    kDistance,
    kVisible
};
Rows rows_of(const std::string& text) {
    std::istringstream lines(text);
    Rows rows;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        std::vector<double>& row = rows.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
            row.push_back(std::strtod(field.c_str(), nullptr));
    }
    return rows;
}
Rows seen(const ScenarioConfig& s, GroundSurvey::What what, double smallest_px) {
    GroundSurvey survey;
    survey.what = what;
    return rows_of(survey_footprint(s, survey, {0, smallest_px}));
}

// The heights of the mesh that a picture shows, over the site's plane, by its own rays; the camera looks straight down.
class PictureHeights {
  public:
    PictureHeights(const ScenarioConfig& s, double camera_m) : camera_(s), camera_m_(camera_m) {
        TruthRequest request = truth_request(s);
        request.stars = request.visibility = false, request.position = true;
        truth_ = make_truth(s, camera_.renderer(), request);
        truth_.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling), {1, 1});
        camera_.report(truth_);
    }
    double at(int x, int y) const {
        return camera_m_ -
               static_cast<double>(truth_.layers.position_m.row(y, 2)[static_cast<std::size_t>(x)]);
    }
    int width() const { return truth_.raster.width_px; }
    int height() const { return truth_.raster.height_px; }

  private:
    StillCamera camera_;
    double camera_m_;
    FrameTruth truth_;
};

// The middle of what is higher than all within `half` of a place by a rise [steps from the place's own].
template <class HeightAt>
Vec2d middle_of_top(int half, double rise_m, const HeightAt& height_m_at) {
    double lowest_m = 1e9, count = 0, sum_x = 0, sum_y = 0;
    for (int y = -half; y <= half; ++y)
        for (int x = -half; x <= half; ++x) lowest_m = std::min(lowest_m, height_m_at(x, y));
    for (int y = -half; y <= half; ++y)
        for (int x = -half; x <= half; ++x)
            if (height_m_at(x, y) > lowest_m + rise_m) count += 1, sum_x += x, sum_y += y;
    EXPECT_GT(count, 4);
    return {sum_x / count, sum_y / count};
}

// Stones stand in the picture where the list has them: of the ground that the picture's rays meet, the middle of what is
// higher than all around it by a third of the stone's height is within a pixel and a half of that of the seeded heights about the listed place. A stone is
// a ball cut by planes, and others stand beside it, so that this middle is no stone's own; in the mean over all of them it is, within a third of a pixel.
TEST(GroundFootprint, BouldersAreWhereThePictureHasThem) {
    const ScenarioConfig s = above_the_site(
        60, {"terrain.globe.relief.deviation_m=0.01", "terrain.globe.craters.largest_m=0.3",
             "terrain.globe.boulders.smallest_m=0.5", "terrain.globe.boulders.abundance=0.05"});
    const PictureHeights heights(s, 60);
    const MappedBody body = ground_body(s);
    GroundHeights seeded(*s.terrain->globe, body);
    int compared = 0;
    Vec2d sum;
    for (const auto& row : seen(s, GroundSurvey::What::kBoulders, 9)) {
        EXPECT_EQ(row[kVisible], 1);
        const int half = static_cast<int>(std::lround(0.75 * row[kDiameterPx]));
        const int x0 = static_cast<int>(row[kX]), y0 = static_cast<int>(row[kY]);
        if (x0 < half || y0 < half || x0 + half >= heights.width() || y0 + half >= heights.height()) continue;
        const double rise_m = 0.33 * row[kFigure], pixel_m = row[kDiameter] / row[kDiameterPx];
        const Vec2d seen_px =
            middle_of_top(half, rise_m, [&](int x, int y) { return heights.at(x0 + x, y0 + y); });
        const LocalPlane plane({row[kLongitude] * kDegree_rad, row[kLatitude] * kDegree_rad, 0}, body.figure);
        const HeightSquare square = seeded.square(plane, (half + 1) * pixel_m, pixel_m);
        // The top of the picture is north.
        const Vec2d seeded_px =
            middle_of_top(half, rise_m, [&](int x, int y) { return square.height_m(x, -y); });
        const Vec2d off{x0 + 0.5 + seen_px.x - row[kX], y0 + 0.5 + seen_px.y - row[kY]};
        EXPECT_NEAR(off.x, seeded_px.x, 1.5) << row[kEast] << ' ' << row[kNorth];
        EXPECT_NEAR(off.y, seeded_px.y, 1.5) << row[kEast] << ' ' << row[kNorth];
        sum.x += off.x, sum.y += off.y;
        ++compared;
    }
    ASSERT_GT(compared, 5);
    EXPECT_NEAR(sum.x / compared, 0, 0.33);
    EXPECT_NEAR(sum.y / compared, 0, 0.33);
}

// Craters lie there, too: the middle of each that is not worn flat is lower than the circle of its rim by most of what its shape says, and what is
// deeper than half of that lies about it, in the mean within a pixel; others lie over some.
TEST(GroundFootprint, CratersAreWhereThePictureHasThem) {
    const ScenarioConfig s =
        above_the_site(400, {"terrain.globe.relief.deviation_m=0.01", "terrain.globe.craters.smallest_m=6",
                             "terrain.globe.craters.largest_m=60", "terrain.globe.boulders.abundance=0"});
    const PictureHeights heights(s, 400);
    const CraterProfile profile;
    int compared = 0;
    Vec2d mean_px{0, 0};
    for (const auto& row : seen(s, GroundSurvey::What::kCraters, 16)) {
        const double radius_px = 0.5 * row[kDiameterPx];
        if (row[kFigure] > 0.2 || row[kX] < 2 * radius_px || row[kY] < 2 * radius_px ||
            row[kX] > heights.width() - 2 * radius_px || row[kY] > heights.height() - 2 * radius_px)
            continue;
        const double floor_m = heights.at(static_cast<int>(row[kX]), static_cast<int>(row[kY]));
        double rim_m = 0;
        for (int k = 0; k < 8; ++k)
            rim_m += heights.at(static_cast<int>(row[kX] + radius_px * std::cos(k * kPi / 4)),
                                static_cast<int>(row[kY] + radius_px * std::sin(k * kPi / 4))) /
                     8;
        // Others lie over it, and the mesh has an edge every two or three pixels.
        const double expected_m = CraterProfile::fresh_depth(row[kDiameter]) * row[kDiameter] *
                                  (profile.height(1, row[kFigure]) - profile.height(0, row[kFigure]));
        EXPECT_GT(rim_m - floor_m, 0.6 * expected_m) << row[kEast] << ' ' << row[kNorth];
        // The middle of what is deeper than half.
        double sum = 0, sum_x = 0, sum_y = 0;
        const int half = static_cast<int>(radius_px);
        for (int y = -half; y <= half; ++y)
            for (int x = -half; x <= half; ++x) {
                const int at_x = static_cast<int>(row[kX]) + x, at_y = static_cast<int>(row[kY]) + y;
                if (std::hypot(x, y) < radius_px && heights.at(at_x, at_y) < 0.5 * (rim_m + floor_m))
                    sum += 1, sum_x += at_x + 0.5, sum_y += at_y + 0.5;
            }
        ASSERT_GT(sum, 4);
        const Vec2d off_px{sum_x / sum - row[kX], sum_y / sum - row[kY]};
        EXPECT_LT(std::hypot(off_px.x, off_px.y), radius_px / 3) << row[kEast] << ' ' << row[kNorth];
        mean_px.x += off_px.x, mean_px.y += off_px.y;
        ++compared;
    }
    ASSERT_GT(compared, 3);
    EXPECT_LT(std::hypot(mean_px.x, mean_px.y) / compared, 1);
}

// Places are east and north of the site, which the camera stands above, and of the size that the lens makes of them.
TEST(GroundFootprint, PlacesAreThoseOfTheLens) {
    const ScenarioConfig s = above_the_site(200, {"terrain.globe.boulders.smallest_m=0.5"});
    const double focal_px = s.camera.focal_length_m / s.camera.pitch_m;
    const auto rows = seen(s, GroundSurvey::What::kBoulders, 3);
    ASSERT_GT(rows.size(), 3u);
    for (const auto& row : rows) {
        // The camera is 200 m over the site's plane, the ground some metres off it.
        EXPECT_NEAR((row[kX] - 160) / focal_px * 200, row[kEast], 2);
        EXPECT_NEAR((128 - row[kY]) / focal_px * 200, row[kNorth], 2);
        EXPECT_NEAR(row[kDiameterPx], row[kDiameter] / row[kDistance] * focal_px, 0.01);
    }
}

// Returns what a run tells of the ground in its picture.
SeenGroundThings told_by_run(const ScenarioConfig& s) {
    const auto ground = ground_truth_of(s);
    StillCamera camera(s);
    FrameTruth truth = make_truth(s, camera.renderer(), truth_request(s));
    truth.raster = raster_of(s.camera, static_cast<int>(s.quality.oversampling), {1, 1});
    camera.report(truth);
    return ground->find(truth);
}

// The truth of a run's frames has the same lists, without the picture's rays.
TEST(GroundFootprint, TruthListsTheSame) {
    const ScenarioConfig s = above_the_site(
        150, {"terrain.globe.boulders.smallest_m=0.5", "outputs.truth={port: 5012, ground_px: 4}"});
    const SeenGroundThings found = told_by_run(s);
    EXPECT_EQ(found.left_out, "");
    for (const auto& [things, what] : {std::pair{&found.craters, GroundSurvey::What::kCraters},
                                       {&found.boulders, GroundSurvey::What::kBoulders}}) {
        const Rows rows = seen(s, what, 4);
        ASSERT_EQ(things->size(), rows.size());
        ASSERT_GT(rows.size(), 1u);
        for (const auto& row : rows)
            EXPECT_TRUE(std::any_of(things->begin(), things->end(), [&](const SeenGroundThing& thing) {
                return std::abs(thing.place_px.x - row[kX]) < 1e-3 &&
                       std::abs(thing.place_px.y - row[kY]) < 1e-3 &&
                       std::abs(thing.diameter_m - row[kDiameter]) < 1e-3 && !thing.visible;
            }));
    }
    EXPECT_EQ(ground_truth_of(above_the_site(150)), nullptr);
}

TEST(GroundFootprint, TruthSaysWhyItListsNothing) {
    const SeenGroundThings many = told_by_run(above_the_site(
        300, {"terrain.globe.craters.smallest_m=0.2", "outputs.truth={port: 5012, ground_px: 0.2}"}));
    EXPECT_TRUE(many.craters.empty() && many.boulders.empty());
    EXPECT_THAT(many.left_out, HasSubstr("outputs.truth.ground_px: the picture has more of them"));
}

// Ground without stones still has craters.
TEST(GroundFootprint, TruthListsCratersWhereThereAreNoBoulders) {
    const SeenGroundThings found = told_by_run(above_the_site(
        150, {"terrain.globe.boulders.abundance=0", "outputs.truth={port: 5012, ground_px: 4}"}));
    EXPECT_EQ(found.left_out, "");
    EXPECT_GT(found.craters.size(), 1u);
    EXPECT_TRUE(found.boulders.empty());
}

TEST(GroundFootprint, APictureWithoutGroundIsRefused) {
    const ScenarioConfig s = above_the_site(100, {"camera_pose.attitude_euler_deg=[0, 0, 0]"});
    try {
        seen(s, GroundSurvey::What::kCraters, 3);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("--footprint: no ground is in the picture"));
    }
}

}  // namespace
}  // namespace hilcam
