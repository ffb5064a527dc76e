#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "emulator/zoo/zoo_bench.h"

namespace hilcam {
namespace {

ZooMember made_member(const std::string& name, double rms, double lights) {
    ZooMember out;
    out.name = name;
    out.all.error = {2 * rms, rms, 1, 100};
    out.all.error_rms = rms;
    out.all.blocks = {200, 20, 30, 10};
    out.all.false_lights = lights;
    ZooViewFigures view;
    static_cast<ZooFigures&>(view) = out.all;
    view.name = "+x 0.5 sun 25", view.reference_frames = 8;
    out.views = {view};
    return out;
}

ZooBench made_zoo() {
    ZooBench out;
    out.members = {made_member("bus", 1, 4), made_member("a_long_name", 3, 0), made_member("dish", 2, 8)};
    return out;
}

TEST(ZooReport, HasALineForEachAndTheWorstAndTheMedian) {
    std::istringstream lines(zoo_bench_text(made_zoo()));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        rows.emplace_back();
        for (std::string word; words >> word;) rows.back().push_back(word);
    }
    ASSERT_EQ(rows.size(), 8u);  // two of headings, one empty
    const auto row_of = [&](const std::string& name) {
        for (const auto& row : rows)
            if (!row.empty() && row[0] == name) return row;
        return std::vector<std::string>(14);
    };
    EXPECT_EQ(row_of("a_long_name")[1], "6.00");  // p99
    EXPECT_EQ(row_of("bus")[2], "1.00");          // rms
    EXPECT_EQ(row_of("bus")[5], "15.00");         // per cent of blocks
    EXPECT_EQ(row_of("bus")[11], "-");            // no centre of light
    EXPECT_EQ(row_of("worst")[2], "3.00");
    EXPECT_EQ(row_of("worst")[9], "8");
    EXPECT_EQ(row_of("median")[2], "2.00");
    EXPECT_EQ(row_of("median")[9], "4");
}

TEST(ZooReport, JsonHasTheSameAndTheViews) {
    const nlohmann::json told = zoo_bench_json(made_zoo());
    ASSERT_EQ(told["members"].size(), 3u);
    const nlohmann::json& bus = told["members"][0];
    EXPECT_EQ(bus["name"], "bus");
    EXPECT_EQ(bus["all_views"]["blocks_over_10_fraction"], 0.15);
    EXPECT_EQ(bus["all_views"]["blocks_unknown"], 20);
    EXPECT_TRUE(bus["all_views"]["centroid_shift_px"].is_null());
    EXPECT_EQ(bus["views"][0]["view"], "+x 0.5 sun 25");
    EXPECT_EQ(bus["views"][0]["reference"]["frames"], 8);
    EXPECT_EQ(told["worst"]["error_sigma_rms"], 3.0);
    EXPECT_EQ(told["median"]["false_lights"], 4.0);
    EXPECT_EQ(told["views"], "few");
}

}  // namespace
}  // namespace hilcam
