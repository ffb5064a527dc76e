// Light that is kept (kept_light.h), against formulas and against random paths.

#include <gtest/gtest.h>

#include <cmath>

#include "render/scene/brdf_microfacet.h"
#include "tests/support/furnace.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

double mean_of(const Stage& s) {
    double sum = 0;
    for (const float value : s.radiance.plane(0)) sum += static_cast<double>(value);
    return sum / static_cast<double>(s.radiance.plane(0).size());
}

// All bounces in a closed box, so that walls of every reflectance are as bright as the black body; a wall of
// 0.9 sends light ten times around.
TEST(KeptLight, AFurnaceIsWhiteInside) {
    EXPECT_NEAR(furnace_mean("kept", 2, 0.3, 1) / furnace_black(), 1, 0.005);
    EXPECT_NEAR(furnace_mean("kept", 2, 0.9, 1) / furnace_black(), 1, 0.02);
}

// A lamp in the middle of a white sphere: I / R^2 at every place, and all of the geometric series.
TEST(KeptLight, AnIntegratingSphereHasAllBounces) {
    constexpr double kWhite = 0.8;
    constexpr float kIntensity_w_sr_um = 100;
    Stage s;
    s.scene.sun_irradiance_1au_w_m2_um = {};
    s.quality.path_model = "kept";
    s.camera(16, 0.3);
    const Vec3d middle_m{0.2, 0.1, 0.3};
    s.add(sphere(60, lambert(kWhite), s.grid), middle_m);
    Spectrum intensity;
    intensity.bin.fill(kIntensity_w_sr_um);
    s.scene.lamps.push_back({"lamp", 0, intensity, {}});
    s.world.lamps.resize(1);
    s.world.lamps[0] = {middle_m, {0, 0, 1}, 1};
    s.render();
    EXPECT_NEAR(mean_of(s) / (kWhite / kPi * static_cast<double>(kIntensity_w_sr_um) / (1 - kWhite)), 1,
                0.01);
}

// A floor at z = 0 and a wall of the same size that stands on its edge, both two metres wide.
SceneObject corner(const MaterialConfig& material, const SpectralGrid& grid) {
    return object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}},
                     {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, material, grid);
}

Stage corner_stage(const char* model, const MaterialConfig& material, int samples) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = 12;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = samples;
    s.quality.rays_across = 0;
    s.camera(48, 0.4);
    // Seen from above, the wall to the right; the Sun from the left, so that it lights the wall more than the
    // floor.
    s.add(corner(material, s.grid), {0, 0, 4});
    s.sun({-2, 0.3, -1});
    return s;
}

// What the wall sends to the floor and back, against paths twelve surfaces deep: diffuse, and with facets.
TEST(KeptLight, ACornerIsAsRandomPathsHaveIt) {
    MaterialConfig metal = lambert(0.8);
    metal.model = ReflectionModel::kMetal;
    metal.roughness = 0.6;
    for (const MaterialConfig& material : {lambert(0.8), metal}) {
        Stage direct = corner_stage("direct", material, 2), paths = corner_stage("path", material, 8),
              kept = corner_stage("kept", material, 2);
        paths.quality.facets_behind_diffuse = 0;
        for (Stage* s : {&direct, &paths, &kept}) s->render();
        const double between = mean_of(paths) - mean_of(direct);
        EXPECT_GT(between, 0.05 * mean_of(direct));
        // From the second bounce on facets are kept as paint: between rough metal walls that is an eighth too
        // much.
        const double error = material.model == ReflectionModel::kMetal ? 0.14 : 0.015;
        EXPECT_NEAR((mean_of(kept) - mean_of(direct)) / between, 1, error);
    }
}

// Two endless plates, nearly: between them what the Sun brings in by a bounce is kept as paths have it, and
// nothing depends on a seed.
TEST(KeptLight, NothingIsLeftToChance) {
    Stage s = corner_stage("kept", lambert(0.8), 1);
    s.render();
    const std::vector<float> first(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
    s.renderer->render(s.world, {2, 7}, s.radiance, s.points, s.stats);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
    EXPECT_EQ(s.stats.secondary_rays, 0u);
}

// A frame does not depend on the frames before it, also where the light of another Sun was kept in between.
TEST(KeptLight, AFrameIsAFunctionOfItsWorld) {
    Stage s = corner_stage("kept", lambert(0.8), 1);
    s.render();
    const std::vector<float> first(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
    s.sun({1, 0.3, -1});
    s.render_again();
    EXPECT_FALSE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
    s.sun({-2, 0.3, -1});
    s.render_again();
    EXPECT_TRUE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
}

// The Earth over a floor that its wall hides half of it from: as random paths find it.
TEST(KeptLight, EarthshineIsHiddenByTheObjectsOwnParts) {
    const auto light = [](const char* model, int samples) {
        Stage s = corner_stage(model, lambert(0.8), samples);
        s.scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        s.earth(0.3);
        // A disk of 68 degrees to the right, for the floor behind the wall in part; the Sun behind the floor.
        s.world.bodies[BodyId::kEarth].world_m = {9e6, 0, -7e6};
        s.sun({-0.5, 0, 1});
        s.render();
        return mean_of(s);
    };
    const double paths = light("path", 8);
    EXPECT_GT(paths, 0);
    EXPECT_NEAR(light("kept", 2) / paths, 1, 0.06);
}

// Inside a closed body there is no light to keep, unless lamps may be there; outside everything is free.
TEST(TransferTable, LeavesOutWhatNoLightReaches) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject box = cube(lambert(0.5), grid);
    const std::vector<std::uint8_t> glass(1);
    const TransferTable outside(box.mesh, glass, {60, 2000, false});
    const TransferTable both(box.mesh, glass, {60, 2000, true});
    EXPECT_GT(outside.size(), 500u);
    EXPECT_EQ(outside.entries(), 0u);
    EXPECT_NEAR(static_cast<double>(both.size()) / static_cast<double>(outside.size()), 2, 0.1);
    EXPECT_TRUE(outside.is_whole() && both.is_whole());
    NodesAbout about;
    EXPECT_TRUE(outside.nodes().find({0.5f, 0.1f, 0.2f}, {{1, 0, 0}, 0, false}, about));
    EXPECT_GT(about.count, 0);
    EXPECT_TRUE(outside.nodes().find({0.5f, 0.1f, 0.2f}, {{-1, 0, 0}, 0, true}, about));
    EXPECT_EQ(about.count, 0);
    EXPECT_FALSE(outside.nodes().find({3, 3, 3}, {{1, 0, 0}, 0, false}, about));
}

// Two parallel squares a side apart: each sends the other 0.1998 of what leaves it (Howell, Menguc & Siegel,
// Thermal Radiation Heat Transfer, configuration factor C-11).
TEST(TransferTable, ParallelSquaresMeetTheirViewFactor) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject plates =
        object_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                  {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}, lambert(0.5), grid);
    for (const int directions : {16, 60, 256}) {
        const TransferTable table(plates.mesh, std::vector<std::uint8_t>(1), {directions, 3000, false});
        // Entries belong to the inner sides alone, which are half of the nodes.
        const double factor =
            static_cast<double>(table.entries()) / (0.5 * static_cast<double>(table.size()) * directions);
        EXPECT_NEAR(factor / 0.1998, 1, directions == 16 ? 0.06 : 0.04) << directions;
    }
}

// Meshes that no one would draw: without area, with holes, with the normals inwards, with a sliver.
TEST(TransferTable, TakesWhatMeshesThereAre) {
    const SpectralGrid grid{{0.5, 0.6}};
    const std::vector<std::uint8_t> glass(1);
    const SceneObject point = object_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}, lambert(0.5), grid);
    EXPECT_EQ(TransferTable(point.mesh, glass, {60, 2000, false}).size(), 0u);
    const SceneObject sliver =
        object_of({{0, 0, 0}, {1000, 0, 0}, {1000, 1e-4f, 0}}, {{0, 1, 2}}, lambert(0.5), grid);
    EXPECT_GT(TransferTable(sliver.mesh, glass, {60, 2000, false}).size(), 0u);
    SceneObject open = cube(lambert(0.5), grid);
    for (auto& t : open.mesh.triangles) std::swap(t[1], t[2]);
    open.mesh.triangles.pop_back(), open.mesh.surface_of_triangle.pop_back();
    const TransferTable table(open.mesh, glass, {60, 2000, false});
    EXPECT_GT(table.entries(), 0u);
    EXPECT_TRUE(table.is_whole());
}

}  // namespace
}  // namespace hilcam
