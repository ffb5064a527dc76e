// Finer levels of a map by tiles: a look sees what it would see of a map that is in memory whole, whatever was looked at before.

#include "render/earth/detail_tiles.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/earth_detail_stage.h"

namespace hilcam {
namespace {

// Reads all tiles of a detail into a pool, seen by the frame.
DetailTiles all_tiles(EarthDetail& detail, const EarthMap& below) {
    std::vector<DetailKey> keys;
    for (int level = 0; level < detail.shape().levels; ++level)
        for (int row = 0; row < detail.shape().tiles_down(level); ++row)
            for (int column = 0; column < detail.shape().tiles_across(level); ++column)
                keys.push_back({level, column, row});
    DetailTiles tiles(detail.shape(), keys.size());
    tiles.begin_frame();
    for (const DetailKey& key : keys) {
        const std::size_t place = tiles.take_place();
        tiles.put(place, key, detail.read(key, below, tiles.texels_of(place)));
        EXPECT_TRUE(tiles.choose(key));
    }
    return tiles;
}

MapFootprint random_footprint(std::mt19937& random) {
    std::uniform_real_distribution<float> side(-1, 1);
    const float size = std::exp2(8 * side(random) - 9);  // 1/100 of a texel of the finest map, to 100
    return {size * side(random), size * side(random), size * side(random), size * side(random)};
}

TEST(DetailTiles, ALookIsThatAtTheWholeMap) {
    const EarthMap whole = noise_map(512), below = coarser(whole, 2);
    WholeDetail detail(whole, below.height());
    ASSERT_EQ(detail.shape().levels, 2);
    const DetailTiles tiles = all_tiles(detail, below);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const float u = 2 * place(random) - 0.5f, v = place(random);
        const MapFootprint f = random_footprint(random);
        const EarthSample seen = tiles.sample(below, u, v, f), wanted = whole.sample(u, v, f);
        for (std::size_t c = 0; c < EarthSample::kChannels; ++c)
            ASSERT_NEAR(seen.value[c], wanted.value[c], 2e-4f) << u << " " << v << " " << c;
    }
    EXPECT_NEAR(tiles.sample(below, 0.3f, 0.4f, 0.02f).water(), whole.sample(0.3f, 0.4f, 0.02f).water(),
                1e-5f);
}

TEST(DetailTiles, WhatTheFrameDoesNotSeeIsTheCoarserLevel) {
    const EarthMap whole = noise_map(512), below = coarser(whole, 2);
    WholeDetail detail(whole, below.height());
    DetailTiles tiles(detail.shape(), 8);
    const float u = 100.5f / 1024, v = 60.5f / 512;  // the middle of a texel of the first tile
    const auto put = [&](const DetailKey& key, bool is_whole) {
        const std::size_t place = tiles.take_place();
        detail.read(key, below, tiles.texels_of(place));
        tiles.put(place, key, is_whole);
        tiles.choose(key);
    };
    const auto seen = [&] { return tiles.sample(below, u, v, 0.0f).water(); };
    const auto at_level = [&](float level) {
        EarthSample sum;
        whole.add_at_level(u, v, level, 1, sum);
        return sum.water();
    };
    tiles.begin_frame();
    EXPECT_FLOAT_EQ(seen(), at_level(2));
    put({1, 0, 0}, true);
    EXPECT_FLOAT_EQ(seen(), at_level(1));
    // A tile that could not be read is as one that is not there.
    put({0, 0, 0}, false);
    EXPECT_FLOAT_EQ(seen(), at_level(1));
    // The next frame sees what is chosen for it alone.
    tiles.begin_frame();
    EXPECT_FLOAT_EQ(seen(), at_level(2));
    EXPECT_TRUE(tiles.choose({1, 0, 0}));
    EXPECT_FLOAT_EQ(seen(), at_level(1));
    EXPECT_FALSE(tiles.choose({0, 1, 0}));
}

TEST(DetailTiles, WhatWasNotSeenForLongestMakesRoom) {
    const EarthMap whole = noise_map(512), below = coarser(whole, 2);
    WholeDetail detail(whole, below.height());
    DetailTiles tiles(detail.shape(), 3);
    for (const int column : {0, 1, 2}) {
        tiles.begin_frame();
        tiles.put(tiles.take_place(), {0, column, 0}, true);
        EXPECT_TRUE(tiles.choose({0, column, 0}));
    }
    tiles.begin_frame();
    EXPECT_TRUE(tiles.choose({0, 0, 0}));
    tiles.put(tiles.take_place(), {0, 3, 0}, true);
    EXPECT_TRUE(tiles.choose({0, 3, 0}));
    EXPECT_FALSE(tiles.has({0, 1, 0}));
    EXPECT_TRUE(tiles.choose({0, 2, 0}));
    // All three are seen now.
    EXPECT_EQ(tiles.take_place(), DetailTiles::kNone);
}

// A map whose columns are no multiple of the level's halves: looks are of its own columns, the last of which wrap around.
TEST(DetailTiles, OddSizesHaveNoHole) {
    const EarthMap below = noise_map(64);
    RampDetail detail(600, 300, below.height());
    ASSERT_EQ(detail.shape().levels, 3);
    ASSERT_EQ(detail.shape().columns_at(2), 150);
    const DetailTiles tiles = all_tiles(detail, below);
    for (const float u : {0.0f, 0.1f, 0.4996f, 0.77f, 0.9999f})
        for (const float v : {0.0f, 0.31f, 0.9999f}) {
            // The ramp goes down from pole to pole.
            EXPECT_NEAR(tiles.sample(below, u, v, 0.0f).water(), v, 0.004f) << u << " " << v;
            EXPECT_NEAR(tiles.sample(below, u, v, 1.9f / 300).water(), v, 0.008f) << u << " " << v;
        }
}

}  // namespace
}  // namespace hilcam
