#include "render/frame/renderer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "render/levels/triangle_order.h"
#include "render/scene/surface.h"
#include "render/visibility/screen_mask.h"
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

// The Moon as a Lambertian sphere: 2/3 A (R/d)^2 E (sin g + (pi - g) cos g) / pi (Lambert 1760). With one ray a pixel it was
// met by none to four.
TEST(Renderer, ABodyOfAFewPixelsHasItsLightWhereverItLies) {
    constexpr double kDistance_m = 4e8, kAlbedo = 0.5;
    const double radius_m = kFigures[index_of(BodyId::kMoon)].equatorial_radius_m;
    for (const double size_px : {0.9, 1.05, 1.5, 2.5, 4.0, 7.9}) {
        Stage s;
        s.camera(32, 16 / (size_px * kDistance_m / (2 * radius_m)));
        BodyConfig config = default_body(BodyId::kMoon);
        config.law = SurfaceLaw::kLambert, config.measured_magnitude = false;
        config.albedo = Curve::constant(kAlbedo);
        s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, config, s.grid), {}};
        s.sun({1, 0, -0.5});
        s.build();
        Vec2d least{1e9, 1e9}, most{-1e9, -1e9};
        for (const Vec2d off_px : {Vec2d{0, 0}, {0.5, 0.5}, {0.13, 0.77}, {0.41, 0.32}, {0.9, 0.06}}) {
            const Vec3d moon_m = kDistance_m * normalized(Vec3d{off_px.x / s.geometry.focal_length_px,
                                                                off_px.y / s.geometry.focal_length_px, 1});
            s.world.bodies[BodyId::kMoon].world_m = moon_m;
            s.render_again();
            const Stage::Light seen = s.light();
            const Vec3d to_sun_m = s.world.bodies.sun_world_m - moon_m;
            const double au = kAstronomicalUnit_m / length(to_sun_m);
            const double g = std::acos(dot(normalized(to_sun_m), normalized(-1 * moon_m)));
            const double truth = 2.0 / 3 * kAlbedo * std::pow(radius_m / kDistance_m, 2) * kSun_w_m2_um * au *
                                 au * (std::sin(g) + (kPi - g) * std::cos(g)) / kPi;
            EXPECT_NEAR(seen.irradiance / truth, 1, 0.01) << size_px << " px, " << off_px.x;
            const Vec2d middle{seen.centroid_px.x - off_px.x, seen.centroid_px.y - off_px.y};
            least = {std::min(least.x, middle.x), std::min(least.y, middle.y)};
            most = {std::max(most.x, middle.x), std::max(most.y, middle.y)};
        }
        EXPECT_LT(std::max(most.x - least.x, most.y - least.y), 0.01) << size_px << " px";
    }
}

// A Lambertian sphere at half phase: the light of a place n goes with n_x, seen over n_z, so that its middle is at
// R int n_x^2 n_z / int n_x n_z = R (pi / 8) / (2 / 3) over the lit half that is seen.
TEST(Renderer, ABodyBelowAPixelStandsAtTheMiddleOfItsLight) {
    constexpr double kDistance_m = 4e8;
    const double radius_m = kFigures[index_of(BodyId::kMoon)].equatorial_radius_m;
    for (const double size_px : {0.1, 0.5, 0.9, 1.1}) {
        Stage s;
        s.camera(32, 16 / (size_px * kDistance_m / (2 * radius_m)));
        BodyConfig config = default_body(BodyId::kMoon);
        config.law = SurfaceLaw::kLambert, config.measured_magnitude = false;
        s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, config, s.grid), {}};
        s.build();
        s.world.bodies[BodyId::kMoon].world_m = {0, 0, kDistance_m};
        for (const Vec3d sun_dir : {Vec3d{1, 0, 0}, {0, -1, 0}}) {
            s.world.bodies.sun_world_m = kAstronomicalUnit_m * sun_dir + Vec3d{0, 0, kDistance_m};
            s.render_again();
            const Vec2d middle_px = s.light().centroid_px;
            const double aside_px = 3 * kPi / 16 * size_px / 2;
            EXPECT_NEAR(middle_px.x, s.geometry.center_px().x + aside_px * sun_dir.x, 0.01) << size_px;
            EXPECT_NEAR(middle_px.y, s.geometry.center_px().y + aside_px * sun_dir.y, 0.01) << size_px;
        }
    }
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

// Whether an object has a mesh of its own or another's, the picture is the same, at every level of detail.
TEST(Renderer, AnObjectLikeAnotherLooksAsOneWithItsOwnMesh) {
    for (const double lod_error_px : {0.0, 1.0}) {
        Stage s;
        s.quality.lod_error_px = lod_error_px;
        SceneObject detailed = cube(lambert(0.5), s.grid);
        detailed.levels = {{sphere(8, lambert(0.5), s.grid).mesh, 0.05, {0}, {}}};
        s.add(plate(lambert(0.2), s.grid), {0, 0, 9});
        s.add(detailed, {-1, 0, 6}, {0.3, 0.4, 0});
        s.add(detailed, {1, 0.5, 5}, {1, 0, 2});
        s.render();
        const std::vector<float> own(s.radiance.all().begin(), s.radiance.all().end());
        s.scene.objects[2] = {"second", 1, {}, {}, {}};
        s.render();
        EXPECT_TRUE(std::equal(own.begin(), own.end(), s.radiance.all().begin())) << lod_error_px;
        s.world.objects[2].position_world_m.x += 0.1;
        s.render_again();
        EXPECT_FALSE(std::equal(own.begin(), own.end(), s.radiance.all().begin()));
    }
}

// Two balls far apart, the camera between them, a long way from either: the sphere that holds both is about it.
TEST(Renderer, ALevelIsChosenByWhatOfAnObjectIsNearest) {
    constexpr float kApart_m = 40;
    Stage s;
    const auto two_balls = [&](int rings) {
        SceneObject both = sphere(rings, lambert(0.5), s.grid), other = both;
        const auto count = static_cast<std::uint32_t>(both.mesh.vertices_m.size());
        for (const Vec3f& at : other.mesh.vertices_m)
            both.mesh.vertices_m.push_back(at + Vec3f{kApart_m, 0, 0});
        for (const auto& [a, b, c] : other.mesh.triangles)
            both.mesh.triangles.push_back({a + count, b + count, c + count});
        both.mesh.surface_of_triangle.assign(both.mesh.triangles.size(), 0);
        both.mesh.normals.insert(both.mesh.normals.end(), other.mesh.normals.begin(),
                                 other.mesh.normals.end());
        return both;
    };
    const SceneObject coarse = two_balls(6);
    SceneObject detailed = two_balls(12);
    detailed.levels = {{coarse.mesh, 0.05, {0}, {}}};
    const double distance_m = 10;  // of the nearer one
    const auto picture = [&](const SceneObject& object, double lod_error_px) {
        s.scene.objects.clear(), s.world.objects.clear();
        s.quality.lod_error_px = lod_error_px;
        s.add(object, {0, 0, distance_m});
        s.render();
        return std::vector<float>(s.radiance.all().begin(), s.radiance.all().end());
    };
    // The error is seen as 0.05 m at 9 m.
    const double error_px = 0.05 / (distance_m - 1) * s.geometry.focal_length_px;
    EXPECT_EQ(picture(detailed, 1.1 * error_px), picture(coarse, 0));
    EXPECT_EQ(picture(detailed, 0.8 * error_px), picture(two_balls(12), 0));
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

// A block beside a plate, both in the Sun: the camera's own sight of them, and what paths find of the block.
TEST(Renderer, RaysAreCountedByWhatTheyAreFor) {
    Stage s;
    s.sun({1, 0, -1});
    s.add(plate(lambert(0.5), s.grid), {0, 0, 3});
    s.add(cube(lambert(0.5), s.grid), {-1, 0, 2.4});
    s.quality.max_depth = 1;
    s.quality.contribution_threshold = 0;
    s.render();
    const RayCounts direct = s.stats;
    EXPECT_GT(direct.shadow_rays, 0u);
    EXPECT_LE(direct.shadow_rays, direct.primary_rays);
    EXPECT_EQ(direct.bounce_shadow_rays + direct.secondary_rays + direct.lamp_rays, 0u);
    s.quality.max_depth = 2;
    s.render();
    EXPECT_EQ(s.stats.primary_rays, direct.primary_rays);
    EXPECT_EQ(s.stats.shadow_rays, direct.shadow_rays);
    EXPECT_GT(s.stats.bounce_shadow_rays, 0u);
    EXPECT_GT(s.stats.secondary_rays, s.stats.bounce_shadow_rays);  // a second surface has one Sun
    EXPECT_EQ(s.stats.lamp_rays, 0u);
}

// Models that a frame does not need cost it nothing: no ray, no look into the air, no point.
TEST(Renderer, NothingUnneededIsTraced) {
    Stage s;
    s.quality.max_depth = 1;
    s.render();  // an empty sky
    EXPECT_EQ(s.stats.primary_rays + s.stats.shadow_rays + s.stats.lamp_rays + s.stats.secondary_rays, 0u);
    s.add(plate(lambert(0.5), s.grid), {0, 0, -3});  // behind the camera
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, -300};  // there as points
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, 300};
    s.render();
    EXPECT_GT(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, 3};
    s.sun({0, 0, 1});  // on its back
    s.render();
    EXPECT_GT(s.stats.primary_rays, 0u);
    EXPECT_EQ(s.stats.shadow_rays, 0u);
    s.sun({0, 0, -1});
    s.render();
    const auto shadow_rays = s.stats.shadow_rays;
    EXPECT_GT(shadow_rays, 0u);
    EXPECT_EQ(s.stats.lamp_rays, 0u);       // no body
    EXPECT_EQ(s.stats.secondary_rays, 0u);  // no depth
    // The Earth out of the field adds its own light, and no primary ray.
    const auto primary_rays = s.stats.primary_rays;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {30e6, 0, -30e6};
    s.quality.contribution_threshold = 0;
    s.render();
    EXPECT_EQ(s.stats.primary_rays, primary_rays);
    EXPECT_EQ(s.stats.shadow_rays, shadow_rays);
    EXPECT_GT(s.stats.lamp_rays, 0u);
    // Below the threshold it is not asked.
    s.quality.contribution_threshold = 0.05;
    s.render();
    EXPECT_EQ(s.stats.lamp_rays + s.stats.secondary_rays + s.stats.bounce_shadow_rays, 0u);
    EXPECT_TRUE(s.points.empty());
}

TEST(Renderer, TheLensBendsWhatItSeesAndTheMaskFollows) {
    Stage s;
    s.geometry.distortion.k1 = -0.3;
    // A small plate off the axis: its middle falls where Brown's formula says.
    SceneObject small = plate(lambert(1), s.grid);
    for (Vec3f& v : small.mesh.vertices_m) v = 0.1f * v;
    s.add(std::move(small), {1.2, 0, 3});
    s.quality.rays_across = 256;
    s.quality.max_depth = 1;
    s.render();
    const double x = 0.4, bent = x * (1 - 0.3 * x * x);
    EXPECT_NEAR(s.light().centroid_px.x, 16 + 32 * bent, 0.05);
    EXPECT_NEAR(s.light().centroid_px.y, 16, 0.02);
}

// Rows read one after another: a camera that turns draws an upright edge aslant.
TEST(Renderer, RollingRowsHaveAPoseOfTheirOwn) {
    Stage s;
    s.models.rays = {"rolling", 1e-3};
    s.quality.max_depth = 1;
    s.add(plate(lambert(1), s.grid), {0, 0, 3});
    // 0.5 rad/s about -y turns the boresight to -x: things move to the right by 32 px 0.5 mrad each row.
    s.world.camera_rate_rad_s = {0, -0.5, 0};
    s.render();
    const auto left_edge = [&](int row) {
        for (int x = 0; x < 40; ++x)
            if (s.radiance.row(row)[static_cast<std::size_t>(x)] > 0) return x;
        return -1;
    };
    s.models.rays.line_time_s = 0.02;
    s.render();
    // From row 12 to row 28: 16 rows of 20 ms, 0.16 rad, 5.1 px and a little more off the axis.
    EXPECT_NEAR(left_edge(28) - left_edge(12), 5.3, 1.1);
}

TEST(ScreenMask, MarksEveryPointOfItsBoxesAndLeavesTheSkyBetweenThem) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const ImageGeometry geometry{64, 48, 8, 50, {}};
    ScreenMask mask(geometry);
    // Two boxes at the ends of a long thing.
    const std::array<std::array<Vec3f, 2>, 2> boxes = {
        {{Vec3f{-9, -1, -1}, Vec3f{-7, 1, 1}}, {Vec3f{7, -1, -1}, Vec3f{9, 1, 1}}}};
    for (int trial = 0; trial < 300; ++trial) {
        const auto vec = [&](double size) {
            return Vec3d{size * uniform(engine), size * uniform(engine), size * uniform(engine)};
        };
        const Pose camera{vec(10), from_rotation_vector(vec(3))};
        const Pose object{vec(30), from_rotation_vector(vec(3))};
        mask.clear();
        mask.add(camera, object, boxes);
        for (int i = 0; i < 50; ++i) {
            const Vec3d p{(i % 2 ? 8 : -8) + uniform(engine), uniform(engine), uniform(engine)};
            const Vec3d in_camera =
                transposed(to_matrix(camera.world_from_body)) *
                (object.position_world_m + to_matrix(object.world_from_body) * p - camera.position_world_m);
            if (in_camera.z <= 0) continue;
            const Vec2d px = geometry.project_px(in_camera);
            if (px.x < -8 || px.y < -8 || px.x >= 72 || px.y >= 56) continue;
            const int x = static_cast<int>(std::floor(px.x)) + 8, y = static_cast<int>(std::floor(px.y)) + 8;
            EXPECT_TRUE(mask.at(x, y));
            EXPECT_TRUE(mask.any({x, y, x + 1, y + 1}));
        }
    }
    mask.clear();
    mask.add({{0, 0, 0}, {}}, {{0, 0, 20}, {}}, boxes);
    EXPECT_TRUE(mask.at(8 + 32 - 20, 8 + 24));
    EXPECT_TRUE(mask.at(8 + 32 + 20, 8 + 24));
    EXPECT_FALSE(mask.at(8 + 32, 8 + 24));
    mask.clear();
    mask.add({{0, 0, 0}, {}}, {{0, 0, -20}, {}}, boxes);  // behind the camera
    EXPECT_FALSE(mask.any({0, 0, 80, 64}));
}

TEST(TriangleOrder, KeepsTheTrianglesAndTheirSurfaces) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> uniform(-5, 5);
    Mesh mesh;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Vec3f at{uniform(engine), uniform(engine), uniform(engine)};
        mesh.vertices_m.insert(mesh.vertices_m.end(), {at, at + Vec3f{0.1f, 0, 0}, at + Vec3f{0, 0.1f, 0}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        mesh.surface_of_triangle.push_back(static_cast<std::uint16_t>(i));
    }
    const auto path_m = [&] {
        double sum = 0;
        for (std::size_t i = 1; i < mesh.triangles.size(); ++i)
            sum += static_cast<double>(
                length(mesh.vertices_m[mesh.triangles[i][0]] - mesh.vertices_m[mesh.triangles[i - 1][0]]));
        return sum;
    };
    const double before = path_m();
    order_triangles(mesh);
    std::vector<bool> seen(1000);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_EQ(mesh.triangles[i][0], 3u * mesh.surface_of_triangle[i]);
        seen[mesh.surface_of_triangle[i]] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 1000);
    EXPECT_LT(path_m(), 0.3 * before);
}

TEST(Surface, PackedNormalsAreGoodToFourThousandthsOfADegree) {
    std::mt19937 engine(1);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 10000; ++i) {
        const Vec3f n = normalized(Vec3f{normal(engine), normal(engine), normal(engine)});
        const double sine = length(cross(to_double(n), to_double(unpack_normal(pack_normal(n)))));
        // Cigolle et al., JCGT 3(2), 2014, table 2: 0.0037 degrees at most with 2 x 16 bits.
        EXPECT_LT(sine, 0.004 * kDegree_rad);
        EXPECT_GT(dot(n, unpack_normal(pack_normal(n))), 0);
    }
}

}  // namespace
}  // namespace hilcam
