// Tiles as frames need them: what a frame sees does not depend on those before, and memory is what was asked for.

#include "render/earth/detail_stream.h"

#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "render/sky/bodies.h"
#include "tests/support/earth_detail_stage.h"
#include "tests/support/earth_stage.h"

namespace hilcam {
namespace {

constexpr double kHeight_m = 500e3, kWidePixel_rad = 4e-3;

// Straight down, above the equator.
DetailView above(double longitude_rad) {
    const Vec3d up{std::cos(longitude_rad), std::sin(longitude_rad), 0};
    return {(kFigures[index_of(BodyId::kEarth)].equatorial_radius_m + kHeight_m) * up,
            -up,
            {1, 0, 0},
            0.3,
            kWidePixel_rad};
}

struct DetailStreamTest : testing::Test {
    static const EarthMap& whole_map() {
        static const EarthMap map = noise_map(2048);
        return map;
    }
    const EarthMap& whole = whole_map();
    EarthMap below = coarser(whole, 4);
    std::shared_ptr<WholeDetail> detail = std::make_shared<WholeDetail>(whole, below.height());

    // A row of looks on the ground below.
    std::vector<float> looks(const DetailTiles& tiles, double longitude_rad) const {
        std::vector<float> out;
        for (int i = -20; i <= 20; ++i)
            out.push_back(tiles
                              .sample(below, static_cast<float>(longitude_rad / (2 * kPi) + 0.5 + i * 2e-4),
                                      0.5f, MapFootprint{2e-5f, 0, 0, 4e-5f})
                              .water());
        return out;
    }
};

TEST_F(DetailStreamTest, WhatAFrameSeesDoesNotDependOnThoseBefore) {
    DetailStream fresh(detail, below, 64 << 20);
    const std::vector<float> wanted = looks(fresh.place(above(0.5)), 0.5);
    EXPECT_EQ(fresh.fault(), "");
    // It is the finest level.
    EXPECT_FLOAT_EQ(
        wanted[20],
        whole.sample(static_cast<float>(0.5 / (2 * kPi) + 0.5), 0.5f, MapFootprint{2e-5f, 0, 0, 4e-5f})
            .water());
    DetailStream moved(detail, below, 64 << 20);
    for (int i = 0; i < 300; ++i) moved.place(above(0.2 + 1e-3 * i));
    EXPECT_EQ(looks(moved.place(above(0.5)), 0.5), wanted);
    moved.place(above(-2)), moved.place(above(2.5));
    EXPECT_EQ(looks(moved.place(above(0.5)), 0.5), wanted);
    // A program that has ended its threads reads for itself.
    DetailStream alone(detail, below, 64 << 20);
    alone.stop_looking_ahead();
    EXPECT_EQ(looks(alone.place(above(0.5)), 0.5), wanted);
}

// Ahead of the frames: a camera that goes on as it did waits for its first ones alone.
TEST_F(DetailStreamTest, TilesAreReadBeforeTheyAreNeeded) {
    DetailStream stream(detail, below, 64 << 20);
    stream.place(above(0));
    const int first = detail->reads;
    for (int i = 1; i < 2000; ++i) {
        stream.place(above(1.5e-3 * i));
        // A frame takes longer than a few tiles.
        while (stream.is_reading_ahead()) std::this_thread::yield();
    }
    EXPECT_EQ(stream.waits(), 1u);
    EXPECT_GT(detail->reads, first + 20);
}

TEST_F(DetailStreamTest, MemoryIsBounded) {
    DetailStream small(detail, below, 1 << 20);
    EXPECT_LE(small.tiles().bytes(), std::size_t{1} << 20);
    small.place(above(0.5));
    EXPECT_THAT(small.explain(), testing::HasSubstr("times as coarse as pixels ask for"));
    DetailStream large(detail, below, 64 << 20);
    large.place(above(0.5));
    EXPECT_THAT(large.explain(), testing::Not(testing::HasSubstr("times as coarse")));
}

TEST_F(DetailStreamTest, ATileThatCannotBeReadIsToldAndShownCoarser) {
    const DetailKey key{0, static_cast<int>((0.5 / (2 * kPi) + 0.5) * 4096) / EarthDetail::kTile,
                        1023 / EarthDetail::kTile};
    detail->damaged.insert({key.level, key.column, key.row});
    DetailStream stream(detail, below, 64 << 20);
    const std::vector<float> seen = looks(stream.place(above(0.5)), 0.5);
    EXPECT_EQ(stream.fault(),
              "earth_surface.layers: 1 tile of whole.tif could not be read; coarser levels are shown there");
    EarthSample coarse;
    whole.add_at_level(static_cast<float>(0.5 / (2 * kPi) + 0.5), 0.5f, 1, 1, coarse);
    EXPECT_FLOAT_EQ(seen[20], coarse.water());
    // It is not tried again for each frame.
    stream.place(above(0.5));
    EXPECT_THAT(stream.fault(), testing::HasSubstr("1 tile "));
}

// Frames of a model with finer levels: what they show is the map in memory whole, and nothing of it from afar.
TEST_F(DetailStreamTest, FramesShowTheFinerLevels) {
    const auto picture = [&](EarthMap ground, std::shared_ptr<EarthDetail> finer, double height_m) {
        Stage s;
        s.camera(64, 0.1);
        s.earth(0.3);
        EarthConfig config;
        config.cloud_thickness = 0;
        s.scene.earth =
            std::make_shared<const EarthModel>(config, std::move(ground), EarthMap(), nullptr, s.grid, finer);
        s.quality.earth_impostor = false;
        s.sun({0.3, 0.5, -1});
        s.world.bodies[BodyId::kEarth].world_m = {
            0, 0, kFigures[index_of(BodyId::kEarth)].equatorial_radius_m + height_m};
        s.render();
        return std::move(s.radiance);
    };
    const auto difference = [](const RadianceImage& a, const RadianceImage& b) {
        double sum = 0, mean = 0;
        for (std::size_t i = 0; i < a.plane(0).size(); ++i) {
            const auto d = static_cast<double>(a.plane(0)[i] - b.plane(0)[i]);
            sum += d * d, mean += static_cast<double>(b.plane(0)[i]);
        }
        const auto n = static_cast<double>(a.plane(0).size());
        return std::sqrt(sum / n) / (mean / n);
    };
    const RadianceImage wanted = picture(whole, nullptr, kHeight_m), seen = picture(below, detail, kHeight_m),
                        coarse = picture(below, nullptr, kHeight_m);
    EXPECT_LT(difference(seen, wanted), 1e-4);
    EXPECT_GT(difference(coarse, wanted), 0.05);
}

}  // namespace
}  // namespace hilcam
