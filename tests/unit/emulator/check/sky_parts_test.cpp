// What `hilcam check` says of the parts of the sky: those that are there, what each takes, and nothing of those that are not.

#include <gmock/gmock.h>

#include <regex>

#include "emulator/check/check_command.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

std::vector<std::string> plan_of(const std::string& scenario, std::vector<std::string> overrides = {}) {
    overrides.insert(overrides.end(), {"camera.width_px=128", "camera.height_px=128", "camera.pitch_um=44"});
    return check_scenario(
               load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/" + scenario + ".yaml", overrides), 0)
        .reports.at(0)
        .plan;
}

TEST(SkyParts, EachPartOfTheEarthIsNamedWithItsTimeAndMemory) {
    const std::vector<std::string> plan = plan_of("earth_day");
    EXPECT_THAT(
        plan,
        Contains(MatchesRegex("earth: map of 4096 x 2048 with its halves; takes .* ms of a core; 89.5 MB")));
    EXPECT_THAT(plan, Contains(MatchesRegex("earth: sea: Cox-Munk glint at 7.0 m/s; takes .* ms of a core")));
    EXPECT_THAT(plan, Contains(MatchesRegex("earth: clouds: .*; takes .* ms of a core; .* MB")));
    EXPECT_THAT(plan, Contains(MatchesRegex("earth: air: .*; takes .* ms of a core; .* MB")));
    EXPECT_THAT(plan, Contains(MatchesRegex("earth: lights of cities; takes .* ms of a core")));
    EXPECT_THAT(plan, Contains(MatchesRegex("stars: [0-9]* in the picture, found in [0-9.]* ms; .* MB")));

    const std::vector<std::string> bare = plan_of(
        "earth_day", {"earth_surface.cloud_thickness=0", "earth_surface.lights=0", "stars.catalogue="});
    EXPECT_THAT(bare, Contains(HasSubstr("earth: sea")));
    EXPECT_THAT(bare, Not(Contains(HasSubstr("earth: clouds"))));
    EXPECT_THAT(bare, Not(Contains(HasSubstr("earth: lights"))));
    EXPECT_THAT(bare, Not(Contains(HasSubstr("stars: "))));
}

TEST(SkyParts, AKeptPictureHasAllPartsInIt) {
    const std::vector<std::string> plan = plan_of("geo_inspection");
    EXPECT_THAT(plan, Contains(HasSubstr("seen as a kept picture")));
    EXPECT_THAT(plan, Contains(MatchesRegex("earth: clouds: [^;]*; [^;]* MB")));
}

// Rays that are followed to the ground, and from there to the Sun, take more than the law.
TEST(SkyParts, TheMoonsReliefIsTheLargestPartOfIt) {
    const std::vector<std::string> plan = plan_of("moon_flyby");
    // The time of a part, or what it is below where it cannot be told.
    const auto time_ms = [&](const std::string& part) {
        const std::regex line_of(part + "; takes (?:less than )?([0-9.]+) ms.*");
        std::smatch found;
        for (const std::string& line : plan)
            if (std::regex_match(line, found, line_of)) return std::stod(found[1]);
        ADD_FAILURE() << part;
        return 0.0;
    };
    EXPECT_GT(time_ms("moon: relief"), time_ms("moon: light of other bodies"));

    const std::vector<std::string> smooth = plan_of(
        "moon_flyby", {"moon={law: hapke, albedo_map: " HILCAM_SOURCE_DIR "/configs/maps/moon_color.png}"});
    EXPECT_THAT(smooth, Not(Contains(HasSubstr("moon: "))));
}

TEST(SkyParts, StrayLightIsToldWhereALensHasSome) {
    EXPECT_THAT(plan_of("sun_beside_the_field"),
                Contains(HasSubstr("stray light of the lens (halo, light from beside the picture): takes ")));
    EXPECT_THAT(plan_of("moon_flyby"), Not(Contains(HasSubstr("stray light"))));
}

}  // namespace
}  // namespace hilcam
