// Light that is kept (kept_light.h), against formulas and against random paths.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "render/brdf/microfacet.h"
#include "render/earth/earth_model.h"
#include "tests/support/furnace.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

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
    EXPECT_NEAR(s.mean() / (kWhite / kPi * static_cast<double>(kIntensity_w_sr_um) / (1 - kWhite)), 1, 0.01);
}

// A floor at z = 0 and a wall of the same size that stands on its edge, both two metres wide.
SceneObject corner(const MaterialConfig& material, const SpectralGrid& grid) {
    return object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}},
                     {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, material, grid);
}

// Returns the object with stripes of these greys across two metres of it, again and again; of 255 alone, which would change
// nothing, as it is.
SceneObject painted(SceneObject object, const std::vector<std::uint8_t>& greys) {
    if (greys == std::vector<std::uint8_t>{255}) return object;
    Texture stripes{"grey", static_cast<int>(greys.size()), 1, {}};
    for (const std::uint8_t grey : greys) stripes.texels.push_back({grey, grey, grey});
    object.mesh.textures = {stripes};
    for (const Vec3f& at_m : object.mesh.vertices_m) object.mesh.uvs.push_back({at_m.x / 2, 0});
    object.mesh.surfaces[0].base_color_texture = object.materials[0].texture = 0;
    return object;
}

Stage corner_stage(const char* model, const MaterialConfig& material, int samples, std::uint8_t grey = 255) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = 12;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = samples;
    s.quality.rays_across = 0;
    s.camera(48, 0.4);
    // Seen from above, the wall to the right; the Sun from the left, so that it lights the wall more than the
    // floor.
    s.add(painted(corner(material, s.grid), {grey}), {0, 0, 4});
    s.sun({-2, 0.3, -1});
    return s;
}

// What the wall sends to the floor and back, against paths twelve surfaces deep: diffuse, and with facets.
TEST(KeptLight, ACornerIsAsRandomPathsHaveIt) {
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    for (const MaterialConfig& material : {lambert(0.8), metal}) {
        Stage direct = corner_stage("direct", material, 2), paths = corner_stage("path", material, 8),
              kept = corner_stage("kept", material, 2);
        paths.quality.facets_behind_diffuse = 0;
        for (Stage* s : {&direct, &paths, &kept}) s->render();
        const double between = paths.mean() - direct.mean();
        EXPECT_GT(between, 0.05 * direct.mean());
        // If facets sent on as paint what other surfaces have sent them, it were an eighth too much between walls of metal.
        EXPECT_NEAR((kept.mean() - direct.mean()) / between, 1, 0.015);
    }
}

constexpr std::uint8_t kGrey = 188;
constexpr double kLinearGrey = 0.5029;  // IEC 61966-2-1
constexpr std::uint8_t kDarkGrey = 99;  // 0.125

// A grey picture is the colour of what lies under a clear layer, but not of that layer's own reflection: light between
// surfaces is that of a material of such a reflectance. Under the layer it is dark, so that the layer sends most.
TEST(KeptLight, APictureUnderALayerIsAsAMaterialOfItsReflectance) {
    const auto between = [](MaterialConfig material, double reflectance, std::uint8_t grey) {
        material.reflectance = Curve::constant(reflectance);
        Stage direct = corner_stage("direct", material, 2, grey),
              kept = corner_stage("kept", material, 2, grey);
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
TEST(KeptLight, APictureColoursMetal) {
    MaterialConfig metal = lambert(0.8);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.6;
    Stage direct = corner_stage("direct", metal, 2, kGrey), paths = corner_stage("path", metal, 8, kGrey),
          kept = corner_stage("kept", metal, 2, kGrey);
    paths.quality.facets_behind_diffuse = 0;
    for (Stage* s : {&direct, &paths, &kept}) s->render();
    EXPECT_NEAR((kept.mean() - direct.mean()) / (paths.mean() - direct.mean()), 1, 0.03);
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

constexpr double kSeen_m = 0.8;  // to either side of the middle, by the next stage's camera

// A camera four metres above things, and all of their light.
Stage stage_above(const char* model, int depth, int samples, int size_px) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = depth;
    s.quality.contribution_threshold = 0;
    s.quality.facets_behind_diffuse = 0;
    s.quality.samples_per_axis = samples;
    s.quality.rays_across = 0;
    s.camera(size_px, kSeen_m / 4);
    return s;
}

// A plate of two metres in the shade, above one side of which a thin bar is in the Sun, as a camera of kSize_px above the plate's
// middle has it, in blocks of 6 x 6 px.
struct PlateAndBar {
    static constexpr std::size_t kSize_px = 48, kBlock_px = 6, kAcross = kSize_px / kBlock_px;
    std::vector<double> pixels;
    std::array<double, kAcross * kAcross> blocks{};  // means

    PlateAndBar(const char* model, const MaterialConfig& material, float bar_m, int samples,
                const std::vector<std::uint8_t>& greys = {255}, const char* visibility = "rays") {
        Stage s = stage_above(model, 2, samples, kSize_px);
        s.quality.visibility = visibility;
        const float x0 = 1.2f, x1 = x0 + bar_m;
        SceneObject object = object_of({{-1, -1, 0},
                                        {1, -1, 0},
                                        {1, 1, 0},
                                        {-1, 1, 0},
                                        {x0, -1, 1},
                                        {x1, -1, 1},
                                        {x1, 1, 1},
                                        {x0, 1, 1}},
                                       {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, material, s.grid);
        s.add(painted(std::move(object), greys), {0, 0, 4});
        s.sun({0.5, 0, 1});
        s.render();
        pixels.assign(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            blocks[block_of(i)] += pixels[i] / (kBlock_px * kBlock_px);
    }
    double column(std::size_t x) const {
        double sum = 0;
        for (std::size_t i = x; i < pixels.size(); i += kSize_px) sum += pixels[i];
        return sum;
    }
    static std::size_t block_of(std::size_t pixel) {
        return pixel / kSize_px / kBlock_px * kAcross + pixel % kSize_px / kBlock_px;
    }
};

// Metal mirrors the bar: of its places some have a direction that meets the bar, of sixty, and others have none. No part of
// the plate is much brighter than the brightest is by random paths.
TEST(KeptLight, ABarThatFewDirectionsMeetIsNoBrighterThanItIs) {
    const auto brightest = [](const char* model, int samples, std::uint8_t grey) {
        MaterialConfig metal = lambert(0.9);
        metal.model = kModel<brdf::Metal>;
        metal.roughness = 0.45;
        const PlateAndBar seen(model, metal, 0.01f, samples, {grey});
        return *std::max_element(seen.blocks.begin(), seen.blocks.end());
    };
    for (const std::uint8_t grey : {std::uint8_t{255}, kGrey}) {
        const double paths = brightest("path", 24, grey);
        EXPECT_GT(paths, 0);
        EXPECT_LT(brightest("kept", 4, grey), 1.5 * paths) << int{grey};
    }
}

// Stripes on metal, a few pixels wide, beside a bar that few directions meet, so that rays follow lobes, and beside one that
// many meet. Four pixels share what lobes meet, and yet each has its own colour: bright stripes are as much brighter than dark
// ones as on paint.
TEST(KeptLight, PixelsOfMetalWithAPictureHaveTheirOwnColours) {
    std::vector<std::uint8_t> stripes;
    for (int i = 0; i < 12; ++i) stripes.insert(stripes.end(), {kGrey, kDarkGrey});
    const auto columns = [&](const MaterialConfig& material, float bar_m) {
        const PlateAndBar plain("kept", material, bar_m, 4, {254}, "buffer"),
            striped("kept", material, bar_m, 4, stripes, "buffer");
        std::vector<double> out;
        for (std::size_t x = 0; x < PlateAndBar::kSize_px; ++x)
            out.push_back(striped.column(x) / plain.column(x));
        return out;
    };
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    const std::vector<double> paint = columns(lambert(0.9), 0.6f);
    const double mean = std::accumulate(paint.begin(), paint.end(), 0.0) / static_cast<double>(paint.size());
    const auto contrast = [&](const std::vector<double>& of) {
        double bright = 0, dark = 0;
        for (std::size_t x = 0; x < of.size(); ++x) (paint[x] > mean ? bright : dark) += of[x];
        return bright / dark;
    };
    EXPECT_GT(contrast(paint), 1.5);
    for (const float bar_m : {0.02f, 0.6f})
        EXPECT_NEAR(contrast(columns(metal, bar_m)) / contrast(paint), 1, 0.03) << bar_m;
}

// A round bar of metal along y that lies on paint, lit from above and a little from the left.
SceneObject paint_and_bar(const SpectralGrid& grid) {
    constexpr int kSides = 64;
    constexpr double kBarRadius_m = 0.15;
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    for (int i = 0; i < kSides; ++i)
        for (const double y : {-1.0, 1.0}) {
            const double angle = 2 * kPi * i / kSides;
            v.push_back(
                to_float({kBarRadius_m * std::cos(angle), y, 0.02 + kBarRadius_m * (1 + std::sin(angle))}));
        }
    for (std::uint32_t i = 0; i < 2 * kSides; i += 2) {
        const std::uint32_t j = (i + 2) % (2 * kSides);
        t.push_back({i, j, i + 1}), t.push_back({j, j + 1, i + 1});
    }
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    return joined(plate(lambert(0.1), grid), object_of(v, t, metal, grid));
}

// The mean radiance of a strip of the paint to the right of the bar, beyond its shadow.
double light_beside_bar(const char* model, int samples, std::size_t places = 3000) {
    constexpr std::size_t kSize_px = 48;
    Stage s = stage_above(model, 4, samples, kSize_px);
    s.kept.nodes = places;
    s.add(paint_and_bar(s.grid), {0, 0, 4});
    s.sun({-1, 0, -3});
    s.render();
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kSize_px * kSize_px; ++i) {
        const double x_m = (2 * (static_cast<double>(i % kSize_px) + 0.5) / kSize_px - 1) * kSeen_m;
        if (x_m > 0.24 && x_m < 0.31) sum += static_cast<double>(s.radiance.plane(0)[i]), ++count;
    }
    return sum / static_cast<double>(count);
}

// A place of a round thing is lit where it faces the Sun and seen where it does not: each of its points sends as it leans. Of the
// light between bar and paint there is 0.99 times as much as by random paths in the mean of ten tables, of which each has few
// places of the strip and is off by 0.1. With directions that a golden section turns from place to place it is 1.16 times.
TEST(KeptLight, WhatIsLitOfABarDoesNotShineBehindIt) {
    const double direct = light_beside_bar("direct", 4), paths = light_beside_bar("path", 16) - direct;
    EXPECT_GT(paths, 0);
    double kept = 0;
    std::size_t places = 14000;
    constexpr int kTables = 14;
    for (int i = 0; i < kTables; ++i, places = places * 10 / 9)
        kept += (light_beside_bar("kept", 4, places) - direct) / kTables;
    EXPECT_NEAR(kept / paths, 1, 0.05);
}

// White paint: how many of a place's sixty directions meet the bar is chance, but where few do, places have what they have
// together with those beside them. The light of a pixel scatters about that of its block by 0.47 of the mean; by each place's own
// directions it is 1.14.
TEST(KeptLight, PaintBelowABarThatFewDirectionsMeetIsEven) {
    const PlateAndBar seen("kept", lambert(0.9), 0.03f, 4);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        const double off = seen.pixels[i] - seen.blocks[PlateAndBar::block_of(i)];
        sum += seen.pixels[i], squares += off * off;
    }
    ASSERT_GT(sum, 0);
    const auto count = static_cast<double>(seen.pixels.size());
    EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.6);
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

// The Earth over a floor that its wall hides half of it from: as random paths find it, on paint, and by
// facets, which see part of it past the wall and the rest as the wall mirrors it.
TEST(KeptLight, EarthshineIsHiddenByTheObjectsOwnParts) {
    const auto light = [](const char* model, const MaterialConfig& material, int samples, std::uint8_t grey) {
        Stage s = corner_stage(model, material, samples, grey);
        s.scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        s.quality.facets_behind_diffuse = 0;
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
            EXPECT_NEAR(light("kept", material, 2, grey) / paths, 1, error)
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
TEST(KeptLight, RoughMetalSendsAllOfTheEarthsLight) {
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
        EXPECT_NEAR(light("kept", roughness, 2) / paths, 1, 0.015) << roughness;
    }
}

// A resin's surface beside the mirror's direction of a small Earth: the few facets that mirror it are met at other angles
// than most, and reflect by those.
TEST(KeptLight, FacetsReflectByTheAngleTheyAreMetAt) {
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
        EXPECT_NEAR(light("kept", 1, tilt_deg) / paths, 1, 0.02) << tilt_deg;
    }
}

// White paint under the Earth, from low orbit to twice the geostationary height: all of its disk's light, in however many parts
// that is taken.
TEST(KeptLight, PaintHasAllOfTheEarthsLightAtAnyHeight) {
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
        EXPECT_NEAR(light("kept", distance_m, 1) / paths, 1, 0.01) << distance_m;
    }
}

// Polished metal beside the Earth's limb: the tails of its lobe, narrow against the disk, reach over it.
TEST(KeptLight, PolishedMetalSeesTheEarthPastItsLimb) {
    const auto light = [](const char* model, int samples, double tilt_rad) {
        MetalStage s(model, 0.15, samples, 16, 0.05);  // alpha 0.0225
        s.add(plate(s.metal, s.grid), {0, 0, 4}, {kPi + tilt_rad, 0, 0});
        s.sun({0, 0.2, 1});  // from above
        s.render();
        return s.mean();
    };
    const double inside = light("kept", 2, 0.3);
    EXPECT_GT(inside, 0);
    // The mirror's direction leaves the disk at a tilt of 35 degrees.
    for (const double tilt_deg : {30.0, 34.0, 36.0, 38.0, 42.0}) {
        const double tilt_rad = tilt_deg * kDegree_rad, paths = light("path", 16, tilt_rad);
        EXPECT_NEAR(light("kept", 2, tilt_rad) / inside, paths / inside, 0.03) << tilt_deg;
    }
}

// A polished plate that mirrors the limb over a pole, 21 km nearer to the middle than over the equator, which
// is 8 mrad from here: as wide as its lobe.
TEST(KeptLight, PolishedMetalSeesALimbThatIsFlattened) {
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
        EXPECT_NEAR(light("kept", 2, tilt_deg) / inside, light("path", 16, tilt_deg) / inside, 0.05)
            << tilt_deg;
}

// Solar panels mirror clouds: what their lobes see of a field of them differs from place to place as its light
// averaged over the lobe does, not as that of single clouds.
TEST(KeptLight, PolishedMetalMirrorsClouds) {
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
            const double error = light("kept", roughness, 2, tilt_deg) - truth;
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
TEST(KeptLight, TheGapsBetweenTilesAreLit) {
    const auto stage = [](const char* model, float above_m) {
        Stage s;
        s.scene.sun_irradiance_1au_w_m2_um.bin.fill(kSun_w_m2_um);
        s.quality.path_model = model;
        s.quality.samples_per_axis = 8;
        s.quality.contribution_threshold = 0;
        s.quality.rays_across = 0;
        s.kept.nodes = 300;
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
        EXPECT_NEAR(stage("kept", above_m) / paths, 1, error);
    }
}

}  // namespace
}  // namespace hilcam
