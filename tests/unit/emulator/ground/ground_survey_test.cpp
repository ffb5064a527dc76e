#include "emulator/ground/ground_survey.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using ::testing::HasSubstr;

// The rows of what is listed of lunar_landing's ground about its site.
std::vector<std::vector<double>> rows_of(const GroundSurvey& survey) {
    static const ScenarioConfig scenario =
        load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/lunar_landing.yaml", {});
    std::istringstream text(survey_ground(*scenario.terrain->globe, ground_body(scenario), survey));
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
        std::vector<double>& row = rows.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
            row.push_back(std::strtod(field.c_str(), nullptr));
    }
    return rows;
}
GroundSurvey about_the_site(GroundSurvey::What what) {
    GroundSurvey survey;
    survey.what = what;
    survey.middle = {23.47 * kDegree_rad, 0.67 * kDegree_rad, 0};
    return survey;
}

// Each thing is as near and as large as was asked for, and what is asked for twice is the same.
TEST(GroundSurvey, ListsWhatIsThere) {
    for (const auto what : {GroundSurvey::What::kCraters, GroundSurvey::What::kBoulders}) {
        GroundSurvey survey = about_the_site(what);
        survey.within_m = 100, survey.smallest_m = 1;
        const auto all = rows_of(survey);
        ASSERT_GT(all.size(), 20u);
        for (const std::vector<double>& row : all) {
            EXPECT_LE(std::hypot(row[2], row[3]), 100.1);
            EXPECT_GE(row[4], 1);
        }
        EXPECT_EQ(rows_of(survey), all);
        survey.smallest_m = 2;
        const auto larger = rows_of(survey);
        EXPECT_LT(larger.size(), all.size());
        for (const std::vector<double>& row : larger) EXPECT_THAT(all, testing::Contains(row));
    }
}

// Slopes are those of the heights beside them: a plane through nine by least squares.
TEST(GroundSurvey, HeightsHaveTheirSlopes) {
    GroundSurvey survey = about_the_site(GroundSurvey::What::kHeights);
    survey.within_m = 5, survey.spacing_m = 0.5;
    const auto rows = rows_of(survey);
    ASSERT_EQ(rows.size(), 21u * 21u);
    for (std::size_t y = 1; y < 20; ++y)
        for (std::size_t x = 1; x < 20; ++x) {
            const auto height = [&](std::size_t i, std::size_t j) {
                return rows[(y + j - 1) * 21 + x + i - 1][4];
            };
            double east = 0, north = 0;
            for (std::size_t k = 0; k < 3; ++k)
                east += (height(2, k) - height(0, k)) / 3, north += (height(k, 2) - height(k, 0)) / 3;
            EXPECT_NEAR(rows[y * 21 + x][5], std::atan(std::hypot(east, north)) / kDegree_rad, 0.02);
        }
}

TEST(GroundSurvey, RefusesTooMany) {
    GroundSurvey survey = about_the_site(GroundSurvey::What::kBoulders);
    survey.within_m = 1e5;
    try {
        rows_of(survey);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("boulders"));
    }
}

}  // namespace
}  // namespace hilcam
