// Renderings whose right answer is a formula.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "render/earth/earth_model.h"
#include "render/paths/path_models.h"
#include "render/sky/sun.h"
#include "tests/support/even_air.h"
#include "tests/support/furnace.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

MaterialConfig mirror() {
    MaterialConfig m;
    m.model = kModel<brdf::Mirror>;
    m.reflectance = Curve::constant(1);
    return m;
}

// What is drawn at the very edge of a body's cone may lie outside of it by rounding. That is drawn once in eight million times:
// a frame in which it is is looked for.
TEST(ClosedForm, LightDrawnAtABodysEdgeIsFinite) {
    Stage s;
    s.quality.path_model = "path";
    s.quality.max_depth = 1;
    s.earth(0.3);
    s.add(plate(lambert(0.8), s.grid), {0, 0, 2});
    Scene scene = copy_of(s.scene);
    scene.air = std::make_unique<EvenAir>();
    scene.earth = std::make_shared<const EarthModel>(EarthConfig{}, seeded_clouds(3, 64), CloudMaps{},
                                                     scene.air.get(), s.grid);
    Renderer renderer(std::move(scene), s.grid, s.geometry, s.quality, s.models);
    s.points.reserve(renderer.max_points());
    const auto middle =
        static_cast<std::uint32_t>(s.radiance.width() * s.radiance.height() / 2 + s.radiance.width() / 2);
    RandomKey key{1, 0};
    // Of the picture's middle, the first sample, at the first surface, to the first body (Tile::random_of()).
    while (random_words(key, RandomPurpose::kPathSample, middle, 16 + 3)[0] >> 9 != 0x7FFFFF) ++key.frame;
    std::uint64_t wrong = 0;
    // How a cone is rounded hangs on its size and direction.
    for (int i = 0; i < 100; ++i) {
        s.world.bodies[BodyId::kEarth].world_m =
            (1e7 + 5e5 * i) * normalized(Vec3d{0.2, 0.4, -0.9 + 0.004 * i});
        renderer.render(s.world, key, s.radiance, s.points, s.stats);
        wrong += s.stats.not_finite;
    }
    EXPECT_EQ(wrong, 0u);
}

// Lambert 1760: a sphere of geometric albedo 2/3 A and phase function (sin g + (pi - g) cos g) / pi, at every
// phase angle from full to a thin crescent, as a picture and as a point alike.
TEST(ClosedForm, SphereFollowsLambertsPhaseLaw) {
    for (const double distance_m : {2e4, 2e6}) {
        Stage s;
        s.camera(256, distance_m < 1e6 ? 1.05 / distance_m : 0.1);
        s.quality.path_model = "direct";
        s.quality.samples_per_axis = distance_m < 1e6 ? 4 : 1;
        s.quality.point_samples = 512;
        s.add(sphere(800, lambert(0.6), s.grid), {0, 0, distance_m});
        s.build();
        for (int degrees = 0; degrees <= 150; degrees += 15) {
            const double g = degrees * kDegree_rad;
            s.sun({std::sin(g), 0, -std::cos(g)});
            s.render_again();
            EXPECT_EQ(s.points.empty(), distance_m < 1e6);
            const double expected =
                2.0 / 3 * 0.6 * kSun_w_m2_um * lambert_phase(g) / (distance_m * distance_m);
            EXPECT_NEAR(s.light().irradiance / expected, 1, 0.005)
                << degrees << " deg at " << distance_m << " m";
        }
    }
}

TEST(ClosedForm, AFurnaceIsWhiteInside) {
    EXPECT_NEAR(furnace_mean("path", 64, 0.3, 16) / furnace_black(), 1, 0.002);
}

// A disk of radiance L and half angle a lights a surface that faces it with pi L sin^2 a.
TEST(ClosedForm, ADiskSourceGivesPiLTimesSineSquared) {
    Stage s;
    s.models.radiance = "emissive";
    s.quality.max_depth = 2;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = 16;
    s.quality.facets_behind_diffuse = 0;
    s.camera(64, 0.01);
    // A disk of 96 corners and the radius that gives it the circle's area, behind the camera; it faces the
    // plate.
    MaterialConfig hot = lambert(0);
    hot.temperature_k = 3000;
    constexpr unsigned kCorners = 96;
    const double radius = std::sqrt(kPi / (0.5 * kCorners * std::sin(2 * kPi / kCorners)));
    std::vector<Vec3f> v = {{0, 0, 0}};
    std::vector<std::array<std::uint32_t, 3>> t;
    for (unsigned i = 0; i < kCorners; ++i) {
        const double a = 2 * kPi * i / kCorners;
        v.push_back(to_float(Vec3d{radius * std::cos(a), radius * std::sin(a), 0}));
        t.push_back({0, 1 + i, 1 + (i + 1) % kCorners});
    }
    s.add(object_of(v, t, hot, s.grid), {0, 0, -0.5}, {0, 0, 0});
    s.add(plate(lambert(0.8), s.grid), {0, 0, 1.5});
    s.sun({0, 0, 1});  // on the plate's back
    s.render();
    double sum = 0;
    for (const float value : s.radiance.plane(0)) sum += value;
    const double mean = sum / static_cast<double>(s.radiance.plane(0).size());
    // Radius 1 at 2 m: sin^2 = 1/5.
    const double expected = 0.8 * static_cast<double>(planck_w_m2_sr_um(s.grid, 3000)[0]) * 0.2;
    // A million samples of which a fifth hit: 0.2 % at one sigma.
    EXPECT_NEAR(mean / expected, 1, 0.008);
}

// Three perpendicular mirrors send every ray back where it came from, after three reflections.
TEST(ClosedForm, ACornerReflectorAnswersAtDepthThree) {
    for (const int depth : {2, 3, 4}) {
        Stage s;
        s.quality.path_model = "path";
        s.quality.max_depth = depth;
        s.quality.contribution_threshold = 1e-4;
        // Corner at the cube's middle, opening along -z after two turns: faces x = 0, y = 0, z = 0 of the
        // first octant.
        s.add(object_of({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 0}, {2, 0, 2}, {0, 2, 2}},
                        {{0, 1, 4}, {0, 4, 2}, {0, 1, 5}, {0, 5, 3}, {0, 2, 6}, {0, 6, 3}}, mirror(), s.grid),
              {0, 0, 6}, {});
        // (1, 1, 1) towards the camera.
        const Vec3d axis = cross(normalized(Vec3d{1, 1, 1}), Vec3d{0, 0, -1});
        const double angle = std::acos(-1 / std::sqrt(3.0));
        s.world.objects[0].world_from_body = from_rotation_vector(angle * normalized(axis));
        // The Sun over the camera's shoulder: three mirrors show its disk around the opposite direction.
        s.sun({0.04, 0.03, -1});
        s.camera(64, 0.1);
        s.render();
        const float most = *std::max_element(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
        const double disk = kSun_w_m2_um / (kPi * std::pow(kSunRadius_m / kAstronomicalUnit_m, 2));
        if (depth < 3) {
            EXPECT_EQ(most, 0);
        } else {
            EXPECT_GT(most, disk);  // its middle, brighter than the mean
            EXPECT_LT(most, 1.4 * disk);
        }
    }
}

// Random paths that end at the first surface are the model that knows no other, and deeper ones add what a wall
// throws on the floor beside it.
TEST(ClosedForm, PathModelsAgree) {
    const auto mean_of = [](const char* model, int depth) {
        Stage s;
        s.quality.path_model = model;
        s.quality.max_depth = depth;
        s.quality.contribution_threshold = 0;
        s.quality.samples_per_axis = 4;
        s.quality.rays_across = 0;
        s.camera(32, 0.4);
        s.add(plate(lambert(0.7), s.grid), {0, 0, 3});
        s.add(plate(lambert(0.7), s.grid), {-1, 0, 2}, {0, kPi / 2, 0});
        s.sun({0.5, 0.2, -1});
        s.render();
        return s.light().irradiance;
    };
    EXPECT_NEAR(mean_of("direct", 1) / mean_of("path", 1), 1, 1e-5);
    EXPECT_GT(mean_of("path", 3), 1.02 * mean_of("path", 1));
}

// A uniform Sun behind a straight edge at height h over a floor: the light falls over 2 h tan(0.267 deg), by
// the share of a disk that a chord leaves. Limb darkening bends the curve, not its width.
TEST(ClosedForm, PenumbraHasTheWidthOfTheSunsDisk) {
    Stage s;
    s.scene.limb_darkening = false;
    s.quality.sun_disk = true;
    s.quality.max_depth = 1;
    s.quality.samples_per_axis = 16;
    s.add(plate(lambert(1), s.grid), {0, 0, 3});
    // Its edge runs along y through x = 0, 1 m over the floor on the camera's side; the camera looks past it.
    s.add(plate(lambert(0), s.grid), {-1, 0, 2});
    s.sun({0, 0, -1});
    // A strip of floor right of the edge's shadow, seen from the right so that the edge is not in the way.
    s.world.camera.position_world_m = {0.5, 0, 0};
    s.camera(256, 0.006);
    s.world.camera.world_from_body = look_along({-0.5, 0, 3}, {0, -1, 0});
    s.render();
    const double rho = std::asin(kSunRadius_m / (kAstronomicalUnit_m + 3));
    double worst = 0;
    for (int x = 0; x < 256; ++x) {
        double sum = 0;
        for (int y = 0; y < 256; ++y) sum += s.radiance.row(y)[static_cast<std::size_t>(x)];
        const Vec3d dir =
            to_matrix(s.world.camera.world_from_body) * s.geometry.direction_camera(x + 0.5, 128);
        const double floor_x = 0.5 + dir.x / dir.z * 3;
        const double c = std::clamp(floor_x / std::tan(rho), -1.0, 1.0);  // edge across the disk, in radii
        const double seen = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / kPi;
        worst = std::max(worst, std::abs(sum / 256 / (kSun_w_m2_um / kPi) - seen));
    }
    // 65,536 samples a column: 0.2 % at one sigma, 256 columns; and a column is 2 % of the penumbra wide.
    EXPECT_LT(worst, 0.015);
}

// The Sun's disk, darker to its edge, has the Sun's irradiance in all.
TEST(ClosedForm, TheSunsDiskCarriesItsIrradiance) {
    Stage s;
    s.quality.samples_per_axis = 8;
    s.camera(256, 0.006);
    s.sun({0.0003, 0.0002, 1});
    s.render();
    EXPECT_NEAR(s.light().irradiance / kSun_w_m2_um, 1, 0.002);
    // Limb darkening is there: the middle is brighter than the mean.
    EXPECT_GT(s.radiance.row(123)[134],
              1.1 * kSun_w_m2_um / (kPi * std::pow(kSunRadius_m / kAstronomicalUnit_m, 2)));
}

// Direct light of the Sun's disk at a mirror-like metal, by both ways of finding it, has one mean.
TEST(ClosedForm, SunsDiskAndItsMiddleGiveTheSameLightInTheMean) {
    const auto light = [](bool disk) {
        Stage s;
        s.quality.sun_disk = disk;
        s.quality.samples_per_axis = 16;
        s.quality.max_depth = 2;
        s.quality.contribution_threshold = 0;
        s.camera(32, 0.3);
        MaterialConfig metal;
        metal.model = kModel<brdf::Metal>;
        metal.reflectance = Curve::constant(0.9);
        metal.roughness = 0.3;
        s.add(plate(metal, s.grid), {0, 0, 3}, {kPi, 0.1, 0});
        s.sun({0.2, 0, -1});
        s.render();
        return s.light().irradiance;
    };
    EXPECT_NEAR(light(true) / light(false), 1, 0.01);
}

// Earth, seen as a point from 0.5 au and as a disk: Lambert's sphere.
TEST(ClosedForm, APlanetAsAPointHasTheLightOfItsDisk) {
    const auto irradiance = [](double distance_m, int size_px, double half_width) {
        Stage s;
        s.earth(0.3);
        s.camera(size_px, half_width);
        s.quality.samples_per_axis = 4;
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, distance_m};
        s.world.bodies.sun_world_m = Vec3d{kAstronomicalUnit_m, 0, distance_m};
        s.render();
        EXPECT_EQ(s.points.size(), distance_m > 5e10 ? 1u : 0u);
        return s.light().irradiance * distance_m * distance_m;
    };
    EXPECT_NEAR(irradiance(1e11, 64, 0.1) / irradiance(1e10, 256, 0.001), 1, 0.005);
}

// Eclipse: a point in the Earth's umbra has no Sun, far from it all; half of the Sun's light is lost where
// the limb runs through the middle of the disk.
TEST(ClosedForm, TheEarthsShadowHasUmbraAndPenumbra) {
    const auto sun_at = [](double off_axis_m) {
        Stage s;
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {off_axis_m, 0, -42e6};
        s.sun({0, 0, -1});
        s.add(plate(lambert(1), s.grid), {0, 0, 3});
        s.quality.max_depth = 1;
        s.render();
        return s.middle() / (kSun_w_m2_um / kPi);
    };
    EXPECT_EQ(sun_at(0), 0);
    EXPECT_NEAR(sun_at(9e6), 1, 1e-3);
    // The limb through the Sun's middle: a uniform disk would lose half, a limb-darkened one too, by
    // symmetry.
    EXPECT_NEAR(sun_at(kEarthEquatorialRadius_m), 0.5, 0.03);
    // Penumbra's edges: 42e6 tan(0.2665 deg) = 195 km on both sides.
    EXPECT_GT(sun_at(kEarthEquatorialRadius_m + 180e3), 0.97);
    EXPECT_LT(sun_at(kEarthEquatorialRadius_m - 180e3), 0.03);
}

}  // namespace
}  // namespace hilcam
