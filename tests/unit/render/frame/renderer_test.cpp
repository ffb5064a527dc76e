#include "render/frame/renderer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

TEST(Renderer, SunlitLambertPlateHasAlbedoTimesIrradianceOverPi) {
    Stage s;
    s.add(plate(lambert(0.5), s.grid), {0, 0, 3});
    const double angle = 0.6;
    s.sun({std::sin(angle), 0, -std::cos(angle)});
    s.quality.max_depth = 1;
    s.render();
    EXPECT_NEAR(s.middle() / (0.5 * kSun_w_m2_um * std::cos(angle) / kPi), 1, 1e-5);
    EXPECT_EQ(s.middle(0), s.middle(1));
    // Side 2 at 3 m, 32 px focal length: 21.3 px of 40 in both directions.
    EXPECT_NEAR(s.stats.coverage, 21.33 * 21.33 / 1600, 0.03);
}

TEST(Renderer, EmptySkyIsBlack) {
    Stage s;
    s.render();
    for (const float value : s.radiance.all()) ASSERT_EQ(value, 0);
}

TEST(Renderer, APlateInTheShadowOfAnotherIsDark) {
    Stage s;
    s.quality.max_depth = 1;
    s.add(plate(lambert(0.5), s.grid), {0, 0, 5});
    s.add(plate(lambert(0.5), s.grid), {3, 0, 2});
    s.sun({1, 0, -1});  // from over the camera's right shoulder, through the second plate
    s.render();
    EXPECT_EQ(s.middle(), 0);
    s.sun({-1, 0, -1});
    s.render();
    EXPECT_GT(s.middle(), 100);
}

TEST(Renderer, SunlitPlateShowsNoAcneAtAnyDistance) {
    for (const double distance : {0.2, 3.0, 1000.0}) {
        Stage s;
        s.quality.max_depth = 1;
        s.geometry.focal_length_px = 8 * distance + 2;  // the plate always covers the middle
        s.add(plate(lambert(1), s.grid), {0, 0, distance});
        const double grazing = 89.9 * kDegree_rad;
        s.sun({std::sin(grazing), 0, -std::cos(grazing)});
        s.render();
        for (int y = 18; y < 22; ++y)
            for (int x = 18; x < 22; ++x)
                ASSERT_NEAR(
                    s.radiance.row(y)[static_cast<std::size_t>(x)] / (kSun_w_m2_um * std::cos(grazing) / kPi),
                    1, 1e-3)
                    << distance;
    }
}

TEST(Renderer, TheEarthHidesWhatIsBehindItAndNotWhatIsBeforeIt) {
    for (const double plate_m : {3e5, 2e7}) {
        Stage s;
        s.earth(0.25);
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, 7e6};
        SceneObject large = plate(lambert(0.75), s.grid);
        for (Vec3f& v : large.mesh.vertices_m) v = 1e6f * v;
        s.add(std::move(large), {0, 0, plate_m});
        s.quality.max_depth = 1;
        s.render();
        const double albedo = plate_m < 7e6 ? 0.75 : 0.25;
        EXPECT_NEAR(s.middle() / (albedo * kSun_w_m2_um / kPi), 1, 1e-3) << plate_m;
    }
}

TEST(Renderer, MirrorShowsAPlateAtDepthTwoAndNotAtDepthOne) {
    MaterialConfig mirror;
    mirror.model = kModel<brdf::Mirror>;
    mirror.reflectance = Curve::constant(0.9);
    for (const int depth : {1, 2}) {
        Stage s;
        s.quality.max_depth = depth;
        s.add(plate(mirror, s.grid), {0, 0, 4}, {kPi, 0, 0});
        // Behind the camera, facing the mirror and a Sun that comes from the mirror's side, off to the right.
        s.add(plate(lambert(0.5), s.grid), {0, 0, -2}, {0, 0, 0});
        s.sun({1, 0, 1});
        s.render();
        const double direct = 0.5 * kSun_w_m2_um * std::cos(kPi / 4) / kPi;
        EXPECT_NEAR(s.middle(), depth == 1 ? 0 : 0.9 * direct, 1e-3 * direct);
    }
}

TEST(Renderer, SunsDiskInTheFieldCarriesItsIrradiance) {
    Stage s;
    s.quality.samples_per_axis = 16;
    s.geometry.focal_length_px = 1500;  // the disk is 14 px wide
    s.sun({0, 0, 1});
    s.render();
    double sum = 0;
    for (const float value : s.radiance.plane(0)) sum += static_cast<double>(value);
    // One pixel's solid angle on the axis; the field is small.
    EXPECT_NEAR(sum / (1500.0 * 1500.0) / kSun_w_m2_um, 1, 0.01);
}

TEST(Renderer, EarthUnderTheSunHasItsLambertRadiance) {
    Stage s;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42e6};
    s.geometry.focal_length_px = 3200;  // the middle pixel sees 8 km off the point under the Sun
    s.render();
    // The Earth's own distance from the Sun takes 6e-4.
    EXPECT_NEAR(s.middle() / (0.3 * kSun_w_m2_um / kPi), 1, 1e-3);
    EXPECT_EQ(s.stats.primary_rays, 0u);  // nothing traced where only the Earth can be
}

// Earthshine on a plate that faces a fully lit Earth and has its back to the Sun: irradiance of a Lambert
// sphere under full phase, 2/3 albedo E (R/d)^2 for d >> R (Lambert 1760).
TEST(Renderer, EarthshineOnAPlateIsThatOfALambertSphere) {
    Stage s;
    s.earth(0.3);
    const double distance = 40 * kEarthEquatorialRadius_m;
    // Earth off the line to the Sun by 1 degree, behind the camera; the plate looks at it, the Sun shines on
    // its back.
    s.world.bodies[BodyId::kEarth].world_m = {0, std::sin(kDegree_rad) * distance,
                                              -std::cos(kDegree_rad) * distance};
    s.sun({0, 0, 1});
    s.add(plate(lambert(0.8), s.grid), {0, 0, 2});
    s.quality.samples_per_axis = 8;
    s.quality.contribution_threshold = 0;
    s.render();
    double sum = 0;
    for (int y = 12; y < 28; ++y)
        for (int x = 12; x < 28; ++x)
            sum += static_cast<double>(s.radiance.row(y)[static_cast<std::size_t>(x)]);
    const double irradiance = 2.0 / 3 * 0.3 * kSun_w_m2_um / (40.0 * 40.0);
    // 16384 samples of a disk whose radiance scatters by about its mean: 3 sigma of 0.8 %, and 0.3 % of
    // flattening.
    EXPECT_NEAR(sum / 256 / (0.8 * irradiance / kPi), 1, 0.03);
}

// A plate's albedo for light from everywhere above it, by moving the Sun over the hemisphere; sees it at a
// cosine `no`.
double seen_albedo(double roughness, double& no) {
    MaterialConfig metal;
    metal.model = kModel<brdf::Metal>;
    metal.reflectance = Curve::constant(1);
    metal.roughness = roughness;
    Stage s;
    s.geometry = {1, 1, 0, 1e4, {}};
    s.quality.max_depth = 1;
    s.add(plate(metal, s.grid), {0, 0, 3}, {kPi - 0.5, 0, 0});
    const Mat3d world_from_plate = to_matrix(s.world.objects[0].world_from_body);
    no = -(world_from_plate * Vec3d{0, 0, 1}).z;
    RadianceImage radiance(1, 1, 2);
    Renderer renderer(copy_of(s.scene), s.grid, s.geometry, s.quality);
    double albedo = 0;
    constexpr int kRings = 100, kSpokes = 200;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSpokes; ++j) {
            // Equal areas: each stands for 2 pi / (rings spokes) of solid angle.
            const double z = (i + 0.5) / kRings, phi = 2 * kPi * (j + 0.5) / kSpokes;
            const double r = std::sqrt(1 - z * z);
            s.sun(world_from_plate * Vec3d{r * std::cos(phi), r * std::sin(phi), z});
            renderer.render(s.world, {1, 1}, radiance, s.points, s.stats);
            albedo += static_cast<double>(radiance.row(0)[0]) / kSun_w_m2_um * 2 * kPi / (kRings * kSpokes);
        }
    return albedo;
}

// A white metal gives back all light, whatever its roughness; what shading with the Sun as a point widens by
// is 0.3 %.
TEST(Renderer, WhiteMetalReflectsAllItGets) {
    double no = 0;
    for (const double roughness : {1.0, 0.8, 0.6, 0.4})
        EXPECT_NEAR(seen_albedo(roughness, no), 1, 4e-3) << roughness;
}

TEST(Renderer, DoesNotDependOnTheThreadCount) {
    const auto picture = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        Stage s;
        s.quality.max_depth = 4;
        MaterialConfig metal;
        metal.model = kModel<brdf::Metal>;
        s.add(plate(lambert(0.9), s.grid), {0, 0, 4}, {kPi, 0.4, 0});
        s.add(plate(metal, s.grid), {1, 0, 4}, {kPi, -0.9, 0});
        s.sun({0.3, 0.2, -1});
        s.render();
        return std::vector<float>(s.radiance.all().begin(), s.radiance.all().end());
    };
    EXPECT_EQ(picture(1), picture(2));
}

TEST(Renderer, StarsFallWhereTheyShouldAndObjectsHideThem) {
    Stage s;
    Star star;
    star.world_dir = normalized(Vec3d{0.25, -0.125, 1});
    star.irradiance_w_m2_um[0] = 1e-8f;
    s.scene.stars = {star, star};
    s.scene.stars[1].world_dir = normalized(Vec3d{0, 0, 1});
    s.add(plate(lambert(0.5), s.grid), {0, 0, 8});  // covers 8 px around the middle
    s.render();
    ASSERT_EQ(s.points.size(), 1u);
    EXPECT_NEAR(s.points[0].position_px.x, 16 + 8, 1e-4);
    EXPECT_NEAR(s.points[0].position_px.y, 16 - 4, 1e-4);
}

TEST(Renderer, CameraInsideAMeshAndNeedleTrianglesStayFinite) {
    Stage s;
    SceneObject object = plate(lambert(0.5), s.grid);
    object.mesh.vertices_m = {{-5, -5, 0.5f}, {5, -5, 0.5f},  {0, 5, 0.5f},
                              {0, 0, 0},      {0, 1e-20f, 0}, {3, 0, 1}};
    object.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    s.add(std::move(object), {0, 0, 0}, {0, 0, 0});
    s.quality.max_depth = 8;
    s.render();
    for (const float value : s.radiance.all()) ASSERT_TRUE(std::isfinite(value));
}

// A checkerboard too fine for the pixels is grey, without moire; one that they resolve is black and white.
TEST(Renderer, TexturesAreAveragedOverAPixel) {
    for (const bool fine : {true, false}) {
        Stage s;
        SceneObject board = plate(lambert(1), s.grid);
        Texture checkers;
        checkers.width = checkers.height = fine ? 512 : 4;
        for (int y = 0; y < checkers.height; ++y)
            for (int x = 0; x < checkers.width; ++x) {
                const auto c = static_cast<std::uint8_t>((x + y) % 2 ? 255 : 0);
                checkers.texels.push_back({c, c, c});
            }
        board.mesh.textures = {checkers};
        board.mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        board.materials[0].texture = 0;
        s.add(std::move(board), {0, 0, 3});
        s.quality.max_depth = 1;
        s.quality.rays_across = 0;
        s.render();
        const double white = kSun_w_m2_um / kPi;
        float least = 1e9f, most = 0;
        for (int y = 14; y < 26; ++y)
            for (int x = 14; x < 26; ++x) {
                least = std::min(least, s.radiance.row(y)[static_cast<std::size_t>(x)]);
                most = std::max(most, s.radiance.row(y)[static_cast<std::size_t>(x)]);
            }
        EXPECT_NEAR(least / white, fine ? 0.5 : 0, fine ? 0.02 : 0.1);
        EXPECT_NEAR(most / white, fine ? 0.5 : 1, fine ? 0.02 : 0.1);
    }
}

}  // namespace
}  // namespace hilcam
