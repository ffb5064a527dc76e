// Kept pictures of the Earth: a frame's depends on its own place and Sun alone, and far cameras alone have one.

#include "render/earth/earth_impostor_cache.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <thread>

#include "render/sky/sun.h"
#include "render/vocabulary/units.h"
#include "tests/support/earth_stage.h"

namespace hilcam {
namespace {

constexpr double kImpostorPixel_rad = 1.2e-2;  // the disk from geostationary height is 25 pixels wide

Vec3d on_equator(double distance_m, double longitude_rad) {
    return {distance_m * std::cos(longitude_rad), distance_m * std::sin(longitude_rad), 0};
}

struct EarthImpostorCacheTest : testing::Test {
    SpectralGrid grid{std::vector<double>{0.4, 0.55, 0.7}};
    EarthModel earth{EarthConfig{}, seeded_clouds(3, 64), EarthMap(), nullptr, grid};
    Spectrum sun = solar_irradiance_1au_w_m2_um(grid);

    // A row of looks across the disk.
    static std::array<Spectrum, 16> looks(const EarthImpostor& picture, Vec3d camera_m) {
        const Vec3d ahead = -normalized(camera_m), right = normalized(cross(ahead, Vec3d{0, 0, 1})),
                    down = cross(ahead, right);
        std::array<Vec3d, 9> dirs;
        for (int i = 0; i < 9; ++i)
            dirs[static_cast<std::size_t>(i)] =
                ahead + (i % 3 - 1) * 0.18 * right + (i / 3 - 1) * 0.18 * down;
        EarthImpostor::Floats x, y;
        for (std::size_t i = 0; i < 16; ++i) x[i] = static_cast<float>(i) / 15, y[i] = 0.45f;
        std::array<Spectrum, 16> out;
        picture.look(picture.tile(camera_m, dirs), x, y, 16, 1, out);
        return out;
    }
};

TEST_F(EarthImpostorCacheTest, WhatAFrameHasDoesNotDependOnThoseBefore) {
    const Vec3d here = on_equator(42164e3, 0.5), sun_dir = on_equator(1, 1.1);
    EarthImpostorCache fresh(earth, sun, kImpostorPixel_rad, EarthModel::kHighest_m);
    ASSERT_TRUE(fresh.place(here, sun_dir));
    const std::array<Spectrum, 16> wanted = looks(fresh.picture(), here);
    EXPECT_GT(wanted[8][0], 10);
    EXPECT_EQ(wanted[0][0], 0);
    EarthImpostorCache moved(earth, sun, kImpostorPixel_rad, EarthModel::kHighest_m);
    // The Sun goes on by less than a step a frame, so that pictures are made ahead as well as at once; then both jump back.
    for (int i = 0; i < 80; ++i)
        ASSERT_TRUE(moved.place(on_equator(42164e3, 0.45 + 1e-5 * i), on_equator(1, 0.9 + 3e-4 * i)));
    ASSERT_TRUE(moved.place(here, sun_dir));
    const std::array<Spectrum, 16> seen = looks(moved.picture(), here);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(seen[i].bin, wanted[i].bin) << i;
}

// A frame that needs a picture which is being made ahead makes the rest of it.
TEST_F(EarthImpostorCacheTest, SeveralThreadsMakeOnePicture) {
    const Vec3d here = on_equator(42164e3, 0.5), sun_dir = on_equator(1, 1.1);
    const auto lights = [&](int threads) {
        EarthImpostor picture(kImpostorPixel_rad, EarthModel::kHighest_m, earth.seen_height_m(0));
        picture.begin(EarthImpostor::key_of(here, sun_dir));
        std::vector<std::thread> team;
        for (int i = 0; i < threads; ++i) team.emplace_back([&] { picture.make_rest(earth, sun); });
        for (std::thread& one : team) one.join();
        picture.make_rest(earth, sun);  // nothing is left
        return looks(picture, here);
    };
    const std::array<Spectrum, 16> alone = lights(1), together = lights(3);
    EXPECT_GT(alone[8][0], 10);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(together[i].bin, alone[i].bin) << i;
}

// Page faults of this process [pages].
long faults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

TEST_F(EarthImpostorCacheTest, LaterPicturesAreMadeInMemoryThatTheFirstHasTaken) {
    constexpr double kFinePixel_rad = 1e-3;
    EarthImpostorCache kept(earth, sun, kFinePixel_rad, EarthModel::kHighest_m);
    const auto show = [&](double longitude_rad) {
        ASSERT_TRUE(kept.place(on_equator(42164e3, longitude_rad), on_equator(1, 1.1)));
    };
    show(0.1);
    const long before = faults();
    show(0.2), show(0.3);
    const auto picture_pages =
        static_cast<long>(kept.bytes() / 3 / static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
    EXPECT_GT(picture_pages, 200);
    EXPECT_LT(faults() - before, picture_pages / 4);
}

TEST_F(EarthImpostorCacheTest, FarCamerasAloneHaveOne) {
    EarthImpostorCache kept(earth, sun, kImpostorPixel_rad, EarthModel::kHighest_m);
    const Vec3d sun_dir = on_equator(1, 0);
    EXPECT_FALSE(kept.place(on_equator(3.9 * kEarthEquatorialRadius_m, 0), sun_dir));
    EXPECT_TRUE(kept.place(on_equator(4.1 * kEarthEquatorialRadius_m, 0), sun_dir));
    // The nearest, whose disk is the widest that there is room for.
    EXPECT_TRUE(kept.place(on_equator(4.00001 * kEarthEquatorialRadius_m, 0), sun_dir));
    // A disk of a few pixels.
    EXPECT_FALSE(kept.place(on_equator(40 * kEarthEquatorialRadius_m, 0), sun_dir));
}

// Mean radiance with the Earth, from geostationary height, so far from the middle of a field of 19 degrees on each side.
double light_at(double off_rad, bool kept) {
    Stage s = earth_stage(128, 0.35, kept, 12, seeded_clouds(3, 64), {});
    s.world.bodies[BodyId::kEarth].world_m = 42164e3 * Vec3d{std::sin(off_rad), 0, std::cos(off_rad)};
    s.render();
    return s.mean();
}

// The last shows a rim of it, with whatever cloud is there.
TEST(EarthImpostorCache, IsAsBrightAsByManyRays) {
    for (const double off_rad : {0.0, 0.2, 0.4})
        EXPECT_NEAR(light_at(off_rad, true) / light_at(off_rad, false), 1, 0.02) << off_rad;
}

// Beside the field, across it, and behind the camera. About a right angle it has no projection.
TEST(EarthImpostorCache, IsNowhereElse) {
    for (double off_rad = 0.8; off_rad < 3.15; off_rad += 0.05)
        EXPECT_EQ(light_at(off_rad, true), 0) << off_rad;
}

}  // namespace
}  // namespace hilcam
