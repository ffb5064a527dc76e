// Pictures taken apart (render/vocabulary/light_part.h): scenes in which one part is all of the light. That part is then the picture to
// the last bit, and every other part is nothing at all.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/scene/material_albedo.h"
#include "render/sky/stars.h"
#include "tests/support/corner.h"
#include "tests/support/earth_detail_stage.h"
#include "tests/support/earth_stage.h"
#include "tests/support/even_air.h"
#include "tests/support/furnace.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// How light is followed, and how the camera sees.
struct Way {
    const char* path_model;
    const char* visibility;

    std::string name() const { return std::string(path_model) + ", " + visibility; }
};
constexpr std::array kAllWays = {Way{"direct", "rays"}, Way{"direct", "buffer"}, Way{"path", "rays"},
                                 Way{"path", "buffer"}, Way{"cached", "rays"},   Way{"cached", "buffer"}};
// Those by which light comes by way of other surfaces.
constexpr std::array kWaysOfSeveral = {Way{"path", "rays"}, Way{"path", "buffer"}, Way{"cached", "rays"},
                                       Way{"cached", "buffer"}};
constexpr std::array kKeptWays = {Way{"cached", "rays"}, Way{"cached", "buffer"}};

// A camera that things fill, by one way.
Stage stage_by(const Way& way, double half_width = 0.1) {
    Stage s;
    s.quality.path_model = way.path_model;
    s.quality.visibility = way.visibility;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = 2;
    s.quality.rays_across = 0;
    s.camera(24, half_width);
    return s;
}

bool is_nothing(const RadianceImage& image) {
    return std::all_of(image.all().begin(), image.all().end(), [](float value) { return value == 0; });
}
// True when the images are the same to the last bit, for numbers that are no zeros.
bool is_same(const RadianceImage& a, const RadianceImage& b) {
    return std::equal(a.all().begin(), a.all().end(), b.all().begin(), b.all().end());
}
double mean(const RadianceImage& image) {
    double sum = 0;
    for (const float value : image.plane(0)) sum += static_cast<double>(value);
    return sum / static_cast<double>(image.plane(0).size());
}

// The parts of a stage's picture, which it then has. The stage may have been built.
LightParts parts_of(Stage& stage, PixelRecord* record = nullptr) {
    if (!stage.renderer) stage.build();
    PartsBuffer buffer = stage.renderer->make_parts_buffer(stage.radiance);
    stage.renderer->keep_parts(&buffer, record);
    stage.render_again();
    stage.renderer->keep_parts(nullptr);
    return std::move(buffer.parts);
}

// Wants the entries of some pixels in the picture's middle to be all of their light.
void expect_recorded(const Stage& stage, const PixelRecord& record, LightPart part, const std::string& what) {
    double light = 0, recorded = 0;
    for (int y = record.box.y0; y < record.box.y1; ++y)
        for (int x = record.box.x0; x < record.box.x1; ++x)
            light += static_cast<double>(stage.radiance.row(y)[static_cast<std::size_t>(x)]);
    for (const PixelRecord::Entry& entry : record.entries) {
        if (entry.light.bin == Spectrum{}.bin) continue;  // of a source that is off
        EXPECT_EQ(entry.part, part) << what << ": " << name_of(entry.part);
        if (!entry.is_shared) recorded += static_cast<double>(entry.light[0]);
    }
    EXPECT_GT(light, 0) << what;
    EXPECT_NEAR(recorded / light, 1, 1e-5) << what;
}

// Wants all of the picture's light, of which there must be some, to be of these parts.
void expect_only(Stage& stage, const LightParts& parts, std::initializer_list<LightPart> some,
                 const std::string& what) {
    EXPECT_FALSE(is_nothing(stage.radiance)) << what;
    for (std::size_t i = 0; i < kImageParts; ++i) {
        const auto part = static_cast<LightPart>(i);
        if (std::find(some.begin(), some.end(), part) != some.end()) continue;
        EXPECT_TRUE(is_nothing(parts.of(part))) << what << ": " << name_of(part) << " has "
                                                << mean(parts.of(part)) << " of " << mean(stage.radiance);
    }
    EXPECT_TRUE(is_nothing(parts.of(LightPart::kPoints))) << what;
}
void expect_all_is(Stage& stage, LightPart part, const std::string& what) {
    const int middle = stage.radiance.width() / 2;
    PixelRecord record;
    record.box = {middle - 4, middle - 4, middle + 4, middle + 4};
    const LightParts parts = parts_of(stage, &record);
    expect_only(stage, parts, {part}, what);
    expect_recorded(stage, record, part, what);
    EXPECT_TRUE(is_same(parts.of(part), stage.radiance))
        << what << ": " << mean(parts.of(part)) << " of " << mean(stage.radiance);
    EXPECT_TRUE(is_same(parts.sum(), stage.radiance)) << what;
}

MaterialConfig metal(double roughness) {
    MaterialConfig m = lambert(0.8);
    m.model = kModel<brdf::Metal>;
    m.roughness = roughness;
    return m;
}
std::string name_of(const MaterialConfig& material) {
    return material.model == kModel<brdf::Metal> ? "metal " + std::to_string(material.roughness) : "paint";
}
MaterialConfig mirror() {
    MaterialConfig m = lambert(0.9);
    m.model = kModel<brdf::Mirror>;
    return m;
}

TEST(LightParts, WhatGlowsInTheDarkIsEmission) {
    for (const Way& way : kAllWays) {
        Stage s = stage_by(way);
        s.scene.sun_irradiance_1au_w_m2_um = {};
        s.models.radiance = "emissive";
        MaterialConfig hot = lambert(0.3);
        hot.temperature_k = 3000;
        s.add(plate(hot, s.grid), {0, 0, 4});
        expect_all_is(s, LightPart::kEmission, way.name());
    }
}

// A direction drawn from the surface's own reflection may meet the Sun's disk: that is the Sun's light as well.
TEST(LightParts, TheSunOnWhatTheCameraSeesIsDirect) {
    for (const Way& way : kAllWays)
        for (const bool disk : {false, true})
            for (const MaterialConfig& material : {lambert(0.8), metal(0.6)}) {
                Stage s = stage_by(way);
                s.quality.sun_disk = disk;
                s.add(plate(material, s.grid), {0, 0, 4});
                s.sun({0.3, 0.2, -1});
                expect_all_is(s, LightPart::kSun,
                              way.name() + (disk ? ", disk, " : ", ") + name_of(material));
            }
}

TEST(LightParts, LampsOnWhatTheCameraSeesAreDirect) {
    for (const Way& way : kAllWays) {
        Stage s = stage_by(way);
        s.scene.sun_irradiance_1au_w_m2_um = {};
        Spectrum intensity;
        intensity.bin.fill(100);
        s.scene.lamps.push_back({"lamp", 0, intensity, LampBeam::of_angle(1)});
        s.world.lamps.resize(1);
        s.world.lamps[0] = {{0.5, -0.2, 1}, {0, 0, 1}, 1};
        s.add(plate(lambert(0.8), s.grid), {0, 0, 4});
        expect_all_is(s, LightPart::kLamps, way.name());
    }
}

// A full Earth behind the camera, and the Sun behind a plate: from the cache, and by chance, where the paths' own
// directions meet the Earth, too.
TEST(LightParts, TheEarthOnWhatTheCameraSeesIsPlanetshine) {
    for (const Way& way : kWaysOfSeveral)
        for (const MaterialConfig& material : {lambert(0.8), metal(0.6), metal(0.3)}) {
            Stage s = stage_by(way);
            s.earth(0.3);
            s.world.bodies[BodyId::kEarth].world_m = {0, 0, -9e6};
            s.add(plate(material, s.grid), {0, 0, 4}, {kPi, 0.4, 0});
            s.sun({0, 0.3, 1});
            expect_all_is(s, LightPart::kPlanetshine, way.name() + ", " + name_of(material));
        }
}

// A plate that the Sun does not see, and a mirror at 45 degrees beside the picture that throws the Sun on it.
TEST(LightParts, TheSunByWayOfAFlatMirrorIsMirroredSun) {
    for (const Way& way : kKeptWays) {
        Stage s = stage_by(way);
        s.quality.max_depth = 4;
        s.sun({1, 0, 0.02});
        constexpr float kSlant = 0.70710678f;
        const Vec3f middle{-2.5f, 0, 2}, along = 0.9f * Vec3f{kSlant, 0, -kSlant}, across{0, 0.8f, 0};
        s.add(object_of({{-4.5f, -1.5f, 4}, {-0.5f, -1.5f, 4}, {-0.5f, 1.5f, 4}, {-4.5f, 1.5f, 4}},
                        {{0, 1, 2}, {0, 2, 3}}, lambert(0.8), s.grid),
              {0, 0, 0}, {0, 0, 0});
        s.add(object_of({middle - along - across, middle + along - across, middle + along + across,
                         middle - along + across},
                        {{0, 1, 2}, {0, 2, 3}}, mirror(), s.grid),
              {0, 0, 0}, {0, 0, 0});
        // It looks at the light's middle.
        s.world.camera.world_from_body = from_rotation_vector({0, -std::atan2(2.5, 4.0), 0});
        expect_all_is(s, LightPart::kMirroredSun, way.name());
    }
}

// A floor that faces the camera and no light, and a wall on its edge, the upper part of which is in the Sun. The camera sees the floor.
Stage corner_by(const Way& way, const MaterialConfig& floor) {
    Stage s = stage_by(way);
    const SceneObject wall = object_of({{1, -1, 0}, {1, 1, 0}, {1, -1, 2}, {1, 1, 2}}, {{0, 2, 3}, {0, 3, 1}},
                                       lambert(0.8), s.grid);
    s.add(joined(plate(floor, s.grid), wall), {0, 0, 4});
    s.sun({-1, 0, 0.3});
    return s;
}

TEST(LightParts, LightOfAnotherSurfaceIsDiffuseOnPaint) {
    for (const Way& way : kKeptWays) {
        Stage s = corner_by(way, lambert(0.8));
        expect_all_is(s, LightPart::kDiffuse, way.name());
    }
}
// Metal in a box of black bodies, which is the same from everywhere. The camera sees the metal along its normal.
Stage box_by(const Way& way, double roughness) {
    Stage s = stage_by(way, 0.01);
    s.scene.sun_irradiance_1au_w_m2_um = {};
    s.models.radiance = "emissive";
    MaterialConfig hot = lambert(0);
    hot.temperature_k = kFurnace_k;
    SceneObject box = cube(hot, s.grid, 4);
    box.mesh.surface_of_triangle[2] = box.mesh.surface_of_triangle[3] = 1;  // z = 2
    box.mesh.surfaces.resize(2);
    box.materials.push_back(make_material(metal(roughness), s.grid));
    s.add(std::move(box), {0, 0, 0}, {0, 0, 0});
    return s;
}
// The shares of the light from everywhere that metal reflects at once, and after its facets have handed it on to each other, which goes
// everywhere and is of the diffuse part.
struct MetalShares {
    double lobe, base;

    explicit MetalShares(double roughness) {
        const MaterialAlbedo albedo(make_material(metal(roughness), Stage().grid));
        lobe = static_cast<double>(albedo.lobe(1)[0]), base = static_cast<double>(albedo.base(1)[0]);
    }
};

// Rays follow the lobe. Where paths end at the first surface, the cache has all of a wide one, and knows the light by the sixty
// directions of its nodes.
TEST(LightParts, LightOfOtherSurfacesIsGlossyOnMetal) {
    for (const Way& way : kKeptWays)
        for (const double roughness : {0.4, 0.6, 0.8})
            for (const bool rays : {true, false}) {
                Stage s = box_by(way, roughness);
                if (!rays) s.quality.max_depth = 1;
                const LightPart part = rays ? LightPart::kGlossyRays : LightPart::kGlossy;
                const LightParts parts = parts_of(s);
                const std::string what = way.name() + ' ' + std::to_string(roughness);
                expect_only(s, parts, {LightPart::kDiffuse, part}, what);
                const MetalShares shares(roughness);
                EXPECT_NEAR(mean(parts.of(LightPart::kDiffuse)) / (shares.base * furnace_black()), 1, 1e-3)
                    << what;
                EXPECT_NEAR(mean(parts.of(part)) / (shares.lobe * furnace_black()), 1, 0.01) << what;
                EXPECT_NEAR(mean(parts.sum()) / mean(s.radiance), 1, 1e-6) << what;
            }
}

TEST(LightParts, ANarrowLobeIsOfRays) {
    for (const Way& way : kKeptWays)
        for (const double roughness : {0.2, 0.25, 0.3}) {
            Stage s = box_by(way, roughness);
            const LightParts parts = parts_of(s);
            const std::string what = way.name() + ' ' + std::to_string(roughness);
            expect_only(s, parts, {LightPart::kDiffuse, LightPart::kGlossyRays}, what);
            const MetalShares shares(roughness);
            EXPECT_NEAR(mean(parts.of(LightPart::kGlossyRays)) / (shares.lobe * furnace_black()), 1, 1e-4)
                << what;
            EXPECT_NEAR(mean(parts.of(LightPart::kDiffuse)) / (shares.base * furnace_black()), 1, 1e-3)
                << what;
            EXPECT_NEAR(mean(parts.sum()) / mean(s.radiance), 1, 1e-6) << what;
        }
}

// A bar that few directions of a place meet: rays follow the lobe, and have all that facets reflect at once. What they hand on to each
// other is diffuse, as much as paint has, as their albedos are to each other: the bar is hardly lit by the plate.
TEST(LightParts, AWideLobeWhoseLightFewDirectionsBringIsOfRays) {
    for (const Way& way : kKeptWays) {
        const auto stage = [&](const MaterialConfig& material) {
            Stage s = stage_by(way, 0.2);
            const SceneObject bar = object_of({{1.2f, -1, 1}, {1.23f, -1, 1}, {1.23f, 1, 1}, {1.2f, 1, 1}},
                                              {{0, 1, 2}, {0, 2, 3}}, lambert(0.8), s.grid);
            s.add(joined(plate(material, s.grid), bar), {0, 0, 4});
            s.sun({0.5, 0, 1});
            return s;
        };
        Stage painted = stage(lambert(0.8)), s = stage(metal(0.6));
        const double paint = mean(parts_of(painted).of(LightPart::kDiffuse));
        EXPECT_GT(paint, 0);
        const LightParts parts = parts_of(s);
        expect_only(s, parts, {LightPart::kDiffuse, LightPart::kGlossyRays}, way.name());
        const double rays = mean(parts.of(LightPart::kGlossyRays)),
                     diffuse = mean(parts.of(LightPart::kDiffuse));
        EXPECT_GT(rays, 0) << way.name();
        EXPECT_NEAR(diffuse / (MetalShares(0.6).base / 0.8 * paint), 1, 0.02) << way.name();
        EXPECT_NEAR((rays + diffuse) / mean(s.radiance), 1, 1e-6) << way.name();
    }
}

TEST(LightParts, WhatAMirrorShowsIsOfItsRays) {
    for (const Way& way : kWaysOfSeveral) {
        Stage s = stage_by(way);
        s.add(plate(mirror(), s.grid), {0, 0, 4});
        // Behind the camera; the Sun stands behind the mirror.
        s.add(plate(lambert(0.5), s.grid), {0, 0, -2}, {0, 0, 0});
        s.sun({1, 0, 1});
        expect_all_is(s, LightPart::kMirrorRays, way.name());
    }
}

TEST(LightParts, WhatIsSeenThroughAPaneIsTransmission) {
    for (const Way& way : kWaysOfSeveral) {
        Stage s = stage_by(way);
        MaterialConfig glass;
        glass.model = kModel<brdf::Glass>;
        glass.transmittance = Curve::constant(0.7);
        s.add(plate(glass, s.grid), {0, 0, 3});
        s.add(plate(lambert(0.5), s.grid), {0, 0, 5});
        s.sun({0.3, 0, -1});
        expect_all_is(s, LightPart::kTransmission, way.name());
    }
}

TEST(LightParts, WhatRandomPathsFindIsOfPaths) {
    for (const Way& way : {Way{"path", "rays"}, Way{"path", "buffer"}})
        for (const MaterialConfig& material : {lambert(0.8), metal(0.6)}) {
            Stage s = corner_by(way, material);
            expect_all_is(s, LightPart::kPath, way.name() + ", " + name_of(material));
        }
}

TEST(LightParts, ABodyAloneIsBackground) {
    for (const Way& way : kAllWays) {
        Stage s = stage_by(way, 0.2);
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42e6};
        s.sun({0.3, 0.2, -1});
        expect_all_is(s, LightPart::kBackground, way.name());
    }
}
TEST(LightParts, TheEarthByItsModelOrItsKeptPictureIsBackground) {
    for (const bool kept : {false, true}) {
        Stage s = earth_stage(96, 0.2, kept, 2, noise_map(64), seeded_clouds(3, 64));
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42e6};
        expect_all_is(s, LightPart::kBackground, kept ? "cached" : "model");
    }
}
TEST(LightParts, TheSunsDiskIsBackground) {
    for (const Way& way : kAllWays) {
        Stage s = stage_by(way, 0.01);
        s.sun({0, 0, 1});
        expect_all_is(s, LightPart::kBackground, way.name());
    }
}

// A plate in the Sun whose glow is no number: it is dark, and has no parts.
TEST(LightParts, APixelWithoutANumberHasNone) {
    Stage s = stage_by({"direct", "rays"});
    s.models.radiance = "emissive";
    SceneObject object = plate(lambert(0.8), s.grid);
    Spectrum glow;
    glow.bin = {1, std::numeric_limits<float>::quiet_NaN()};
    object.materials[0].emission = ThermalEmission(glow);
    s.add(std::move(object), {0, 0, 4});
    const LightParts parts = parts_of(s);
    EXPECT_GT(s.stats.not_finite, 0u);
    EXPECT_TRUE(is_nothing(s.radiance));
    for (std::size_t i = 0; i < kLightParts; ++i)
        EXPECT_TRUE(is_nothing(parts.of(static_cast<LightPart>(i)))) << kLightPartNames[i];
}

TEST(LightParts, AirBeforeSomethingBlackIsAir) {
    for (const Way& way : {Way{"direct", "rays"}, Way{"path", "rays"}, Way{"cached", "buffer"}}) {
        Stage s = stage_by(way);
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {0, kEarthEquatorialRadius_m + 1e4, 0};
        s.add(plate(lambert(0), s.grid), {0, 0, 4});
        Scene scene = copy_of(s.scene);
        scene.air = std::make_unique<EvenAir>();
        scene.earth = std::make_shared<const EarthModel>(EarthConfig{}, seeded_clouds(3, 64), CloudMaps{},
                                                         scene.air.get(), s.grid);
        s.renderer = std::make_unique<Renderer>(std::move(scene), s.grid, s.geometry, s.quality, s.models);
        expect_all_is(s, LightPart::kAir, way.name());
    }
}

// A star is in no image; its part has the radiance of its pixel that brings its irradiance. A pixel of a rectilinear picture has the
// solid angle cos^3 / f^2.
TEST(LightParts, AStarIsAPoint) {
    Stage s = stage_by({"direct", "rays"}, 0.3);
    Star star;
    star.world_dir = normalized(Vec3d{0.25, -0.125, 1});
    star.irradiance_w_m2_um[0] = 1e-8f;
    s.scene.stars = {star};
    const LightParts parts = parts_of(s);
    EXPECT_TRUE(is_nothing(s.radiance));
    for (std::size_t i = 0; i < kImageParts; ++i)
        EXPECT_TRUE(is_nothing(parts.of(static_cast<LightPart>(i)))) << kLightPartNames[i];
    EXPECT_TRUE(is_nothing(parts.sum()));
    const RadianceImage& points = parts.of(LightPart::kPoints);
    const double cosine = 1 / std::sqrt(1 + 0.25 * 0.25 + 0.125 * 0.125);
    const double f_px = s.geometry.focal_length_px;
    const auto x = static_cast<std::size_t>(12 + f_px * 0.25);
    const int y = static_cast<int>(12 - f_px * 0.125);
    EXPECT_NEAR(static_cast<double>(points.row(y)[x]) / (1e-8 * f_px * f_px / std::pow(cosine, 3)), 1, 1e-5);
    EXPECT_EQ(std::count_if(points.all().begin(), points.all().end(), [](float value) { return value != 0; }),
              1);
}

}  // namespace
}  // namespace hilcam
