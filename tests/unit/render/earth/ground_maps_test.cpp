// The surface by time: months come again each year, instants do not, and between two maps is their mean.

#include "render/earth/ground_maps.h"

#include <gmock/gmock.h>

#include "render/earth/earth_config.h"
#include "render/vocabulary/config_field.h"
#include "tests/support/earth_stage.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

EarthMap even_ground(std::uint8_t grey) {
    EarthMap::Level level{4, 2, {}};
    level.texels.assign(8, EarthMap::Texel{grey, grey, grey, grey});
    return EarthMap(EarthMap::halves(std::move(level)));
}

// Darker than snow, which reflects by a law of its own.
GroundMaps four_seasons() {
    std::vector<GroundMaps::Monthly> maps;
    maps.push_back({1, even_ground(100)});
    maps.push_back({4, even_ground(50)});
    maps.push_back({7, even_ground(25)});
    maps.push_back({10, even_ground(75)});
    return GroundMaps(std::move(maps));
}

TEST(GroundMaps, MonthsComeAgainEachYear) {
    const GroundMaps maps = four_seasons();
    for (const int year : {1999, 2026, 2060}) {
        const auto at = [&](const std::string& day) {
            return maps.times().number_at(parse_utc(std::to_string(year) + day + "T00:00:00Z"));
        };
        // A day is a ninetieth of the way; the mean year is within two of each year's own.
        EXPECT_NEAR(at("-01-16"), 0, 0.03) << year;
        EXPECT_NEAR(at("-04-16"), 1, 0.03) << year;
        EXPECT_NEAR(at("-03-02"), 0.5, 0.04) << year;
        EXPECT_NEAR(at("-10-16"), 3, 0.04) << year;
        // Over the turn of the year, from October's to January's.
        EXPECT_NEAR(at("-12-01"), 3.5, 0.04) << year;
        EXPECT_NEAR(at("-01-01"), 3.84, 0.04) << year;
    }
    // Nothing steps there.
    EXPECT_NEAR(maps.times().number_at(parse_utc("2026-12-31T23:59:59Z")),
                maps.times().number_at(parse_utc("2027-01-01T00:00:01Z")), 0.03);
    EXPECT_DOUBLE_EQ(maps.times().nearest(4.5), 0.5);
    EXPECT_DOUBLE_EQ(maps.times().nearest(-0.25), 3.75);
}

TEST(GroundMaps, BetweenTwoIsTheirMean) {
    const GroundMaps maps = four_seasons();
    const auto at = [&](double number) {
        return static_cast<double>(maps.sample(number, 0.3f, 0.4f, 0.0f).land(2));
    };
    const auto value = [](double code) { return code * code / 65025; };
    EXPECT_NEAR(at(0), value(100), 1e-6);
    EXPECT_NEAR(at(0.25), 0.75 * value(100) + 0.25 * value(50), 1e-6);
    EXPECT_NEAR(at(3.5), 0.5 * value(75) + 0.5 * value(100), 1e-6);
    // Where the year's last step rounds to the first map.
    EXPECT_NEAR(at(4), value(100), 1e-6);
}

TEST(GroundMaps, InstantsStayBeforeTheFirstAndAfterTheLast) {
    std::vector<GroundMaps::Timed> timed;
    timed.push_back({parse_utc("2026-03-01T00:00:00Z"), even_ground(100)});
    timed.push_back({parse_utc("2026-03-11T00:00:00Z"), even_ground(200)});
    const GroundMaps maps(std::move(timed));
    EXPECT_DOUBLE_EQ(maps.times().number_at(parse_utc("2020-01-01T00:00:00Z")), 0);
    EXPECT_NEAR(maps.times().number_at(parse_utc("2026-03-06T00:00:00Z")), 0.5, 1e-9);
    EXPECT_DOUBLE_EQ(maps.times().number_at(parse_utc("2030-01-01T00:00:00Z")), 1);
    EXPECT_DOUBLE_EQ(maps.times().nearest(1.5), 1);
}

// What the disk sends at a time of the year, without clouds.
double light_at(const std::string& day, bool kept) {
    Stage s;
    s.camera(64, 0.2);
    s.earth(0.3);
    EarthConfig config;
    config.cloud_thickness = 0;
    s.scene.earth = std::make_shared<const EarthModel>(config, four_seasons(), CloudMaps(even_ground(0)),
                                                       nullptr, s.grid);
    s.quality.earth_impostor = kept;
    s.quality.visibility = kept ? "buffer" : "rays";
    s.quality.samples_per_axis = kept ? 1 : 4;
    s.sun({0.3, 0.5, -1});
    s.world.time = parse_utc(day + "T00:00:00Z");
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42164e3};
    s.render();
    return s.mean();
}

TEST(GroundMaps, FramesShowTheTimeOfTheYear) {
    const double january = light_at("2026-01-16", false), july = light_at("2026-07-16", false);
    const GroundMaps maps = four_seasons();
    const auto grey = [&](const char* day) {
        return static_cast<double>(
            maps.sample(maps.times().number_at(parse_utc(day)), 0.3f, 0.4f, 0.0f).land(2));
    };
    EXPECT_NEAR(january / july, grey("2026-01-16T00:00:00Z") / grey("2026-07-16T00:00:00Z"), 0.05);
    EXPECT_GT(january / july, 15);  // (100 / 25)^2 in the middles of the months
    EXPECT_NEAR(light_at("2031-01-16", false) / january, 1, 0.04);
    for (const char* day : {"2026-01-16", "2026-03-02", "2026-12-20"})
        EXPECT_NEAR(light_at(day, true) / light_at(day, false), 1, 0.02) << day;
}

std::string ground_refusal(const EarthConfig& config) {
    try {
        for (const EarthGroundConfig& one : config.ground) validate(one);
        validate(config);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(GroundMaps, MistakesAreNamed) {
    EarthConfig config;
    config.map = "earth.map";
    config.ground = {{"a.map", 1, ""}, {"b.map", 7, ""}};
    EXPECT_EQ(ground_refusal(config), "");
    config.ground[1].month = 1;
    EXPECT_THAT(ground_refusal(config),
                HasSubstr("ground.1.month: found 1; accepted: later than the map before, 1"));
    config.ground[1] = {"b.map", 0, "2026-01-01T00:00:00Z"};
    EXPECT_THAT(ground_refusal(config), HasSubstr("ground.1.at_utc: is of another kind"));
    config.ground[0] = {"a.map", 0, "2026-02-01T00:00:00Z"};
    EXPECT_THAT(ground_refusal(config),
                HasSubstr("ground.1.at_utc: found 2026-01-01T00:00:00Z; accepted: later"));
    config.ground = {{"a.map", 0, ""}};
    EXPECT_THAT(ground_refusal(config), HasSubstr("is missing, and at_utc"));
    config.ground = {{"a.map", 3, "2026-02-01T00:00:00Z"}};
    EXPECT_THAT(ground_refusal(config), HasSubstr("both say when the map is"));
    config.ground = {{"a.map", 3, ""}};
    config.layers.emplace_back();
    EXPECT_THAT(ground_refusal(config), HasSubstr("'layers' both say what the surface is"));
}

}  // namespace
}  // namespace hilcam
