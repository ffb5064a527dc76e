// Light that is kept (irradiance_cache.h), against formulas and against random paths.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "render/glossy/glossy_reuse.h"
#include "tests/support/corner.h"
#include "tests/support/furnace.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// All bounces in a closed box, so that walls of every reflectance are as bright as the black body; a wall of
// 0.9 sends light ten times around.
TEST(IrradianceCache, AFurnaceIsWhiteInside) {
    EXPECT_NEAR(furnace_mean("cached", 2, 0.3, 1) / furnace_black(), 1, 0.005);
    EXPECT_NEAR(furnace_mean("cached", 2, 0.9, 1) / furnace_black(), 1, 0.02);
}

// A lamp in the middle of a white sphere: I / R^2 at every place, and all of the geometric series.
TEST(IrradianceCache, AnIntegratingSphereHasAllBounces) {
    constexpr double kWhite = 0.8;
    constexpr float kIntensity_w_sr_um = 100;
    Stage s;
    s.scene.sun_irradiance_1au_w_m2_um = {};
    s.quality.path_model = "cached";
    s.camera(16, 0.3);
    const Vec3d middle_m{0.2, 0.1, 0.3};
    s.add(sphere(60, lambert(kWhite), s.grid), middle_m);
    Spectrum intensity;
    intensity.bin.fill(kIntensity_w_sr_um);
    s.scene.lamps.push_back({"lamp", 0, intensity, {}});
    s.world.lamps.resize(1);
    s.world.lamps[0] = {middle_m, {0, 0, 1}, 1};
    s.render();
    EXPECT_NEAR(s.mean() / (kWhite / kPi * static_cast<double>(kIntensity_w_sr_um) / (1 - kWhite)), 1, 0.01);
}

// What the wall sends to the floor and back, against paths twelve surfaces deep: diffuse, and with facets.
TEST(IrradianceCache, ACornerIsAsRandomPathsHaveIt) {
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    for (const MaterialConfig& material : {lambert(0.8), metal}) {
        Stage direct = corner_stage("direct", material, 2), paths = corner_stage("path", material, 8),
              kept = corner_stage("cached", material, 2);
        paths.quality.facets_behind_diffuse = 0;
        kept.quality.max_depth = 1;  // the cache has the lobes, too
        for (Stage* s : {&direct, &paths, &kept}) s->render();
        const double between = paths.mean() - direct.mean();
        EXPECT_GT(between, 0.05 * direct.mean());
        // If facets sent on as paint what other surfaces have sent them, it were an eighth too much between walls of metal.
        EXPECT_NEAR((kept.mean() - direct.mean()) / between, 1, 0.015);
    }
}

// The same by rays along the lobes, held against the lobes of the cache. What neighbours share where two walls meet leaves out some of what
// stands before one pixel and not before the next: 3 to 4 % of the light. How much depends on
// where the corner is in the pattern of directions, so this is a mean over all places in it.
TEST(GlossyCorner, IsAsTheCacheHasItButForWhatStandsNear) {
    constexpr double kPixel_m = 2 * 0.4 * 4 / 48;
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    for (const std::uint8_t grey : {std::uint8_t{255}, kGrey}) {
        double by_rays = 0, by_cache = 0;
        for (int place = 0; place < kGlossyPattern_px; ++place) {
            Stage direct = corner_stage("direct", metal, 2, grey),
                  rays = corner_stage("cached", metal, 2, grey),
                  kept = corner_stage("cached", metal, 2, grey);
            rays.quality.visibility = "buffer";
            kept.quality.max_depth = 1;
            for (Stage* s : {&direct, &rays, &kept}) {
                s->world.objects[0].position_world_m = {place * kPixel_m, 0, 4};
                s->render();
            }
            by_rays += rays.mean() - direct.mean(), by_cache += kept.mean() - direct.mean();
        }
        EXPECT_NEAR(by_rays / by_cache, 0.97, 0.035) << int{grey};
    }
}

// A grey picture is the colour of what lies under a clear layer, but not of that layer's own reflection: light between
// surfaces is that of a material of such a reflectance. Under the layer it is dark, so that the layer sends most.
TEST(IrradianceCache, APictureUnderALayerIsAsAMaterialOfItsReflectance) {
    const auto between = [](MaterialConfig material, double reflectance, std::uint8_t grey) {
        material.reflectance = Curve::constant(reflectance);
        Stage direct = corner_stage("direct", material, 2, grey),
              kept = corner_stage("cached", material, 2, grey);
        direct.render(), kept.render();
        return kept.mean() - direct.mean();
    };
    MaterialConfig varnish = lambert(0);
    varnish.model = kModel<brdf::Dielectric>;
    varnish.roughness = 0.6;
    varnish.refractive_index = 1.5;
    for (const auto& [material, own] : {std::pair{lambert(0), 0.8}, {varnish, 0.05}}) {
        const double plain = between(material, own * kLinearGrey, 255);
        EXPECT_GT(plain, 0);
        EXPECT_NEAR(between(material, own, kGrey) / plain, 1, 0.02) << material.model;
    }
}

// A picture on metal is the colour of its facets. Light between them is as random paths have it.
TEST(IrradianceCache, APictureColoursMetal) {
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    Stage direct = corner_stage("direct", metal, 2, kGrey), paths = corner_stage("path", metal, 8, kGrey),
          kept = corner_stage("cached", metal, 2, kGrey);
    paths.quality.facets_behind_diffuse = 0;
    kept.quality.max_depth = 1;  // the cache has the lobes, too
    for (Stage* s : {&direct, &paths, &kept}) s->render();
    EXPECT_NEAR((kept.mean() - direct.mean()) / (paths.mean() - direct.mean()), 1, 0.03);
}

// Two endless plates, nearly: between them what the Sun brings in by a bounce is kept as paths have it, and
// nothing depends on a seed.
TEST(IrradianceCache, NothingIsLeftToChance) {
    Stage s = corner_stage("cached", lambert(0.8), 1);
    s.render();
    const std::vector<float> first(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
    s.renderer->render(s.world, {2, 7}, s.radiance, s.points, s.stats);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
    EXPECT_EQ(s.stats.secondary_rays, 0u);
}

// A frame does not depend on the frames before it, also where the light of another Sun was kept in between.
TEST(IrradianceCache, AFrameIsAFunctionOfItsWorld) {
    Stage s = corner_stage("cached", lambert(0.8), 1);
    s.render();
    const std::vector<float> first(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
    s.sun({1, 0.3, -1});
    s.render_again();
    EXPECT_FALSE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
    s.sun({-2, 0.3, -1});
    s.render_again();
    EXPECT_TRUE(std::equal(first.begin(), first.end(), s.radiance.plane(0).begin()));
}

}  // namespace
}  // namespace hilcam
