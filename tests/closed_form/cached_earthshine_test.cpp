// The Earth's light on paint and metal, kept (irradiance_cache.h), against random paths.

#include <gtest/gtest.h>

#include <string_view>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "render/earth/earth_model.h"
#include "tests/support/corner.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// The Earth over a floor that its wall hides half of it from: as random paths find it, on paint, and by
// facets, which see part of it past the wall and the rest as the wall mirrors it.
TEST(IrradianceCache, EarthshineIsHiddenByTheObjectsOwnParts) {
    const auto light = [](const char* model, const MaterialConfig& material, int samples, std::uint8_t grey) {
        Stage s = corner_stage(model, material, samples, grey);
        s.scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        s.quality.facets_behind_diffuse = 0;
        if (model == std::string_view("cached")) s.quality.max_depth = 1;  // the cache has the lobes, too
        s.earth(0.3);
        // A disk of 68 degrees to the right, for the floor behind the wall in part; the Sun behind the floor.
        s.world.bodies[BodyId::kEarth].world_m = {9e6, 0, -7e6};
        s.sun({-0.5, 0, 1});
        s.render();
        return s.mean();
    };
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    for (const MaterialConfig& material : {lambert(0.8), metal})
        for (const std::uint8_t grey : {std::uint8_t{255}, kDarkGrey}) {
            const double paths = light("path", material, 8, grey);
            EXPECT_GT(paths, 0);
            // What the wall mirrors is kept as paint's: little, where it is dark.
            const bool mirrors = material.model == kModel<brdf::Metal>;
            const double error = !mirrors ? 0.06 : grey == 255 ? 0.08 : 0.04;
            EXPECT_NEAR(light("cached", material, 2, grey) / paths, 1, error)
                << material.model << ' ' << int{grey};
        }
}

// Metal of 0.8 under an Earth of 70 degrees of half angle, behind a camera with this field; what there is to
// see is added by the test.
struct MetalStage : Stage {
    MaterialConfig metal = lambert(0.8);

    MetalStage(const char* model, double roughness, int samples, int size_px, double half_width) {
        metal.model = kModel<brdf::Metal>;
        metal.roughness = roughness;
        quality.path_model = model;
        quality.max_depth = 2;
        quality.contribution_threshold = 0;
        quality.samples_per_axis = samples;
        quality.rays_across = 0;
        scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        camera(size_px, half_width);
        earth(0.3);
        world.bodies[BodyId::kEarth].world_m = {0, 0, -6.7875e6};
    }
};

// Rough metal reflects all of the Earth's light that it does: facets that shade each other are counted once.
TEST(IrradianceCache, RoughMetalSendsAllOfTheEarthsLight) {
    const auto light = [](const char* model, double roughness, int samples) {
        MetalStage s(model, roughness, samples, 48, 0.5);
        s.add(sphere(40, s.metal, s.grid), {0, 0, 5});
        s.sun({0, 0, 1});  // behind the sphere
        s.render();
        return s.mean();
    };
    for (const double roughness : {0.3, 0.5, 0.75, 1.0}) {
        const double paths = light("path", roughness, 8);
        EXPECT_GT(paths, 0);
        EXPECT_NEAR(light("cached", roughness, 2) / paths, 1, 0.015) << roughness;
    }
}

// A resin's surface beside the mirror's direction of a small Earth: the few facets that mirror it are met at other angles
// than most, and reflect by those.
TEST(IrradianceCache, FacetsReflectByTheAngleTheyAreMetAt) {
    const auto light = [](const char* model, int samples, double tilt_deg) {
        MetalStage s(model, 1, samples, 16, 0.05);
        MaterialConfig resin = lambert(0);
        resin.model = kModel<brdf::Dielectric>;
        resin.roughness = 0.45;
        resin.refractive_index = 1.55;
        s.add(plate(resin, s.grid), {0, 0, 4}, {kPi + tilt_deg * kDegree_rad, 0, 0});
        s.world.bodies[BodyId::kEarth].world_m = {0, 4.2e7, 0.7e7};
        s.sun({0, 0.3, -1});
        s.render();
        return s.mean();
    };
    for (const double tilt_deg : {30.0, 40.0, 50.0, 60.0, 70.0}) {
        const double paths = light("path", 16, tilt_deg);
        EXPECT_GT(paths, 0);
        EXPECT_NEAR(light("cached", 1, tilt_deg) / paths, 1, 0.02) << tilt_deg;
    }
}

// White paint under the Earth, from low orbit to twice the geostationary height: all of its disk's light, in however many parts
// that is taken.
TEST(IrradianceCache, PaintHasAllOfTheEarthsLightAtAnyHeight) {
    const auto light = [](const char* model, double distance_m, int samples) {
        MetalStage s(model, 1, samples, 24, 0.05);
        s.add(plate(lambert(0.8), s.grid), {0, 0, 4});
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, -distance_m};
        s.sun({0, 0.3, 1});
        s.render();
        return s.mean();
    };
    for (const double distance_m : {6.8e6, 9e6, 1.5e7, 4.2e7, 8.4e7}) {
        const double paths = light("path", distance_m, 16);
        EXPECT_GT(paths, 0);
        EXPECT_NEAR(light("cached", distance_m, 1) / paths, 1, 0.01) << distance_m;
    }
}

// Rough paint with the Earth behind the camera sends more light back than its albedo alone would.
TEST(IrradianceCache, RoughPaintSendsTheEarthsLightByItsOwnLaw) {
    const auto light = [](const char* model, std::size_t law, double tilt_deg, int samples) {
        MetalStage s(model, 1, samples, 16, 0.05);
        MaterialConfig paint = lambert(0.8);
        paint.model = law, paint.roughness = 0.6;
        s.add(plate(paint, s.grid), {0, 0, 4}, {kPi + tilt_deg * kDegree_rad, 0, 0});
        s.sun({0, 0.3, 1});
        s.render();
        return s.mean();
    };
    constexpr double kTilt_deg = 60;
    EXPECT_GT(light("cached", kModel<brdf::OrenNayar>, kTilt_deg, 1),
              1.05 * light("cached", kModel<brdf::Lambert>, kTilt_deg, 1));
    for (const double tilt_deg : {0.0, 30.0, kTilt_deg}) {
        const double paths = light("path", kModel<brdf::OrenNayar>, tilt_deg, 16);
        EXPECT_GT(paths, 0);
        EXPECT_NEAR(light("cached", kModel<brdf::OrenNayar>, tilt_deg, 1) / paths, 1, 0.015) << tilt_deg;
    }
}

// A plate of metal whose faces the mesh has twice, cut along different diagonals: rays from one copy do not meet the other.
TEST(IrradianceCache, FacesThatAMeshHasTwiceAreLitAsOne) {
    const auto light = [](bool twice) {
        MetalStage s("cached", 0.3, 1, 32, 0.02);  // alpha 0.09
        s.quality.visibility = "buffer";
        SceneObject one = plate(s.metal, s.grid), other = one;
        other.mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
        // A wall has rays follow what the plate shows.
        SceneObject wall = object_of({{-1, 1.1f, 0}, {1, 1.1f, 0}, {1, 1.1f, 1}, {-1, 1.1f, 1}},
                                     {{0, 1, 2}, {0, 2, 3}}, lambert(0.5), s.grid);
        SceneObject all = twice ? joined(one, other) : one;
        s.add(joined(all, wall), {0.1, 0.2, 17.3}, {kPi + 0.31, 0.17, 0.05});
        s.sun({0, 0.3, 1});
        s.render();
        return s.mean();
    };
    const double once = light(false);
    EXPECT_GT(once, 0);
    EXPECT_NEAR(light(true) / once, 1, 0.01);
}

// Polished metal beside the Earth's limb: the tails of its lobe, narrow against the disk, reach over it.
TEST(IrradianceCache, PolishedMetalSeesTheEarthPastItsLimb) {
    const auto light = [](const char* model, int samples, double tilt_rad) {
        MetalStage s(model, 0.15, samples, 16, 0.05);  // alpha 0.0225
        s.add(plate(s.metal, s.grid), {0, 0, 4}, {kPi + tilt_rad, 0, 0});
        s.sun({0, 0.2, 1});  // from above
        s.render();
        return s.mean();
    };
    const double inside = light("cached", 2, 0.3);
    EXPECT_GT(inside, 0);
    // The mirror's direction leaves the disk at a tilt of 35 degrees.
    for (const double tilt_deg : {30.0, 34.0, 36.0, 38.0, 42.0}) {
        const double tilt_rad = tilt_deg * kDegree_rad, paths = light("path", 16, tilt_rad);
        EXPECT_NEAR(light("cached", 2, tilt_rad) / inside, paths / inside, 0.03) << tilt_deg;
    }
}

// A polished plate that mirrors the limb over a pole, 21 km nearer to the middle than over the equator, which
// is 8 mrad from here: as wide as its lobe.
TEST(IrradianceCache, PolishedMetalSeesALimbThatIsFlattened) {
    const auto light = [](const char* model, int samples, double tilt_deg) {
        MetalStage s(model, 0.07, samples, 16, 0.002);  // alpha 0.0049
        s.add(plate(s.metal, s.grid), {0, 0, 4}, {kPi + tilt_deg * kDegree_rad, 0, 0});
        // The pole upwards.
        s.world.bodies[BodyId::kEarth].fixed_from_world = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
        s.sun({0, 0.2, 1});
        s.render();
        return s.mean();
    };
    const double inside = light("path", 16, 34.2);
    EXPECT_GT(inside, 0);
    for (const double tilt_deg : {34.4, 34.6, 34.8, 35.0, 35.2})
        EXPECT_NEAR(light("cached", 2, tilt_deg) / inside, light("path", 16, tilt_deg) / inside, 0.05)
            << tilt_deg;
}

// Solar panels mirror clouds: what their lobes see of a field of them differs from place to place as its light
// averaged over the lobe does, not as that of single clouds.
TEST(IrradianceCache, PolishedMetalMirrorsClouds) {
    const auto light = [](const char* model, double roughness, int samples, double tilt_deg) {
        MetalStage s(model, roughness, samples, 8, 0.005);
        s.scene.earth = std::make_shared<const EarthModel>(EarthConfig{}, seeded_clouds(3, 256), EarthMap(),
                                                           nullptr, s.grid);
        s.world.bodies[BodyId::kEarth].fixed_from_world = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
        s.add(plate(s.metal, s.grid), {0, 0, 4}, {kPi + tilt_deg * kDegree_rad, 0, 0});
        s.sun({0, 0.5, 1});
        s.render();
        return s.mean();
    };
    for (const double roughness : {0.07, 0.2}) {
        double paths = 0, paths_squared = 0, error_squared = 0;
        constexpr int kPlaces = 8;
        for (int i = 0; i < kPlaces; ++i) {
            const double tilt_deg = 2 + 3 * i, truth = light("path", roughness, 8, tilt_deg);
            const double error = light("cached", roughness, 2, tilt_deg) - truth;
            paths += truth, paths_squared += truth * truth, error_squared += error * error;
        }
        const double mean = paths / kPlaces, spread = std::sqrt(paths_squared / kPlaces - mean * mean);
        const double error = std::sqrt(error_squared / kPlaces);
        EXPECT_GT(spread / mean, 0.1);
        EXPECT_LT(error / mean, 0.06) << "roughness " << roughness << ", spread " << spread / mean;
    }
}

// A white floor under tiles that cover most of it, a hair above: what is seen of it are the gaps, and those
// have their light.
TEST(IrradianceCache, TheGapsBetweenTilesAreLit) {
    const auto stage = [](const char* model, float above_m) {
        Stage s;
        s.scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        s.quality.path_model = model;
        s.quality.samples_per_axis = 8;
        s.quality.contribution_threshold = 0;
        s.quality.rays_across = 0;
        s.transfer.probes = 300;
        s.camera(64, 0.3);
        std::vector<Vec3f> v = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        std::vector<std::array<std::uint32_t, 3>> t = {{0, 1, 2}, {0, 2, 3}};
        constexpr int kTiles = 16;
        for (int i = 0; i < kTiles * kTiles; ++i) {
            const float step = 2.0f / kTiles, x = -1 + step * static_cast<float>(i % kTiles),
                        y = -1 + step * static_cast<float>(i / kTiles), w = 0.9f * step, z = above_m;
            const auto n = static_cast<std::uint32_t>(v.size());
            for (const Vec3f corner :
                 {Vec3f{x, y, z}, Vec3f{x + w, y, z}, Vec3f{x + w, y + w, z}, Vec3f{x, y + w, z}})
                v.push_back(corner);
            t.push_back({n, n + 1, n + 2}), t.push_back({n, n + 2, n + 3});
        }
        SceneObject tiled = object_of(v, t, lambert(0.8), s.grid);
        tiled.mesh.surfaces.resize(2);
        std::fill(tiled.mesh.surface_of_triangle.begin() + 2, tiled.mesh.surface_of_triangle.end(),
                  std::uint16_t{1});
        tiled.materials.push_back(make_material(lambert(0), s.grid));
        s.add(std::move(tiled), {0, 0, 4});
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, -9e6};
        s.sun({0, 0.2, 1});
        s.render();
        return s.mean();
    };
    // Points under the tiles' edges count, too, as far as they see out.
    for (const auto& [above_m, error] : {std::pair(2e-4f, 0.08), std::pair(2e-3f, 0.3)}) {
        const double paths = stage("path", above_m);
        EXPECT_GT(paths, 0);
        EXPECT_NEAR(stage("cached", above_m) / paths, 1, error);
    }
}

}  // namespace
}  // namespace hilcam
