// Clouds by time: an instant has two maps and a share of each, and frames and kept pictures show their mean.

#include "render/earth/cloud_maps.h"

#include <gmock/gmock.h>

#include "render/earth/earth_impostor_cache.h"
#include "render/sky/sun.h"
#include "render/vocabulary/config_field.h"
#include "tests/support/earth_stage.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr TimeTai kNoon{800'000'000'000'000'000};
TimeTai hours_after_noon(double hours) { return kNoon + std::llround(hours * 3600e9); }

// The map is even: cloud and top as codes, on land of one grey.
EarthMap even_clouds(std::uint8_t cloud, std::uint8_t top) {
    EarthMap::Level level{4, 2, {}};
    EarthMap::Texel texel{80, 80, 80, 80};
    texel[EarthSample::kCloud] = cloud, texel[EarthSample::kCloudTop] = top;
    level.texels.assign(8, texel);
    return EarthMap(EarthMap::halves(std::move(level)));
}

// A clear sky, after six hours thick clouds, and after another thin ones.
CloudMaps three_maps() {
    std::vector<CloudMaps::Timed> maps;
    maps.push_back({kNoon, even_clouds(0, 10)});
    maps.push_back({hours_after_noon(6), even_clouds(200, 100)});
    maps.push_back({hours_after_noon(7), even_clouds(50, 60)});
    return CloudMaps(std::move(maps));
}

TEST(CloudMaps, AnInstantHasTwoMapsAndAShare) {
    const CloudMaps maps = three_maps();
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(-3)), 0);
    EXPECT_DOUBLE_EQ(maps.times().number_at(kNoon), 0);
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(1.5)), 0.25);
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(6)), 1);
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(6.75)), 1.75);
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(7)), 2);
    EXPECT_DOUBLE_EQ(maps.times().number_at(hours_after_noon(1000)), 2);
    EXPECT_DOUBLE_EQ(CloudMaps(even_clouds(1, 1)).times().number_at(kNoon), 0);
    EXPECT_TRUE(CloudMaps(EarthMap()).empty());
}

TEST(CloudMaps, BetweenTwoInstantsIsTheirMean) {
    const CloudMaps maps = three_maps();
    const auto at = [&](double number) { return maps.sample(number, 0.3f, 0.4f, 0.0f); };
    EXPECT_EQ(at(0).cloud(), 0);
    EXPECT_NEAR(at(0.25).cloud(), 0.25f * 200 / 255, 1e-6f);
    EXPECT_NEAR(at(1.5).cloud(), 125.0f / 255, 1e-6f);
    EXPECT_NEAR(at(2).cloud(), 50.0f / 255, 1e-6f);
    // Where there is no cloud at first the top is that of what comes.
    EXPECT_NEAR(at(0.25).cloud_top_m(), EarthSample::kHighestTop_m * 100 / 255, 0.1f);
    EXPECT_NEAR(at(1.5).cloud_top_m(), EarthSample::kHighestTop_m * (200 * 100 + 50 * 60) / (250 * 255),
                0.1f);
}

// What the disk sends [W m^-2 sr^-1 um^-1, as a mean over the picture] at an instant.
double light_at(TimeTai time, bool kept) {
    Stage s = earth_stage(64, 0.2, kept, 4, even_clouds(0, 0), three_maps());
    s.world.time = time;
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42164e3};
    s.render();
    return s.mean();
}

TEST(CloudMaps, FramesShowThemAsTimeGoesOn) {
    const double clear = light_at(kNoon, false), half = light_at(hours_after_noon(3), false),
                 thick = light_at(hours_after_noon(6), false);
    EXPECT_GT(half, 1.2 * clear);
    EXPECT_GT(thick, 1.2 * half);
    EXPECT_EQ(light_at(hours_after_noon(-1), false), clear);
    // The kept picture is of the nearest 256th of the way.
    for (const double hours : {-1.0, 0.0, 1.501, 3.0, 6.0, 6.502, 9.0})
        EXPECT_NEAR(light_at(hours_after_noon(hours), true) / light_at(hours_after_noon(hours), false), 1,
                    0.02)
            << hours;
}

std::string refusal(const EarthConfig& config) {
    try {
        validate(config);
        for (const CloudsConfig& one : config.clouds) validate(one);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CloudMaps, MistakesAreNamed) {
    EarthConfig config;
    config.map = "earth.map";
    config.clouds = {{"a.map", "2026-01-01T00:00:00Z"}, {"b.map", "2026-01-01T06:00:00Z"}};
    EXPECT_EQ(refusal(config), "");
    config.cloud_seed = 3;
    EXPECT_THAT(refusal(config), HasSubstr("'cloud_seed' both say where clouds are"));
    config.cloud_seed = 0;
    std::swap(config.clouds[0], config.clouds[1]);
    EXPECT_THAT(refusal(config), HasSubstr("clouds.1.at_utc: found 2026-01-01T00:00:00Z; accepted: later"));
    config.clouds[0].at_utc = "yesterday";
    EXPECT_THAT(refusal(config), HasSubstr("yesterday"));
    config.clouds.resize(1), config.clouds[0].at_utc = "2026-01-01T00:00:00Z";
    config.map.clear();
    EXPECT_THAT(refusal(config), HasSubstr("has no effect without 'map'"));
}

}  // namespace
}  // namespace hilcam
