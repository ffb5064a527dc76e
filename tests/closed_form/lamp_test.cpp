// Lamps, against formulas: I b(theta) cos(sigma) / d^2.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "render/shading/lamp_light.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kIntensity_w_sr_um = 100;
constexpr double kWhite = 0.5;  // of the plates

// Nothing but lamps shines.
class LampStage : public Stage {
  public:
    LampStage() {
        scene.sun_irradiance_1au_w_m2_um = {};
        quality.path_model = "direct";
        camera(15, 0.01);
    }
    void lamp(Vec3d position_m, Vec3d axis = {0, 0, 1}, const LampBeam& beam = {}) {
        Spectrum intensity;
        for (int b = 0; b < grid.size(); ++b) intensity[b] = static_cast<float>(kIntensity_w_sr_um);
        scene.lamps.push_back({"lamp", 0, intensity, beam});
        world.lamps.resize(scene.lamps.size());
        world.lamps[scene.lamps.size() - 1] = {position_m, normalized(axis), 1};
    }
    // Where a pixel's middle meets the plane z.
    Vec3d place(int x, int y, double z_m) const { return z_m * geometry.direction_camera(x + 0.5, y + 0.5); }
    float at(int x, int y) const { return radiance.row(y)[static_cast<std::size_t>(x)]; }
    float center() const { return at(7, 7); }
};

// Of a Lambertian plate across the boresight at z.
double plate_radiance(Vec3d place_m, Vec3d lamp_m, double relative_intensity) {
    const Vec3d to_lamp_m = lamp_m - place_m;
    const double d = length(to_lamp_m);
    return kWhite / kPi * kIntensity_w_sr_um * relative_intensity * (-to_lamp_m.z / d) / (d * d);
}

// A ray's direction, its length and some ten products, each to 6e-8 and the position's 16 half-ulps to 1e-6.
constexpr double kSinglePrecision = 2e-5;

TEST(Lamps, APlateHasTheirIntensityTimesCosineOverTheDistanceSquared) {
    const Vec3d lamp_m{0.5, -0.2, 1};
    const double half_rad = 30 * kDegree_rad;
    LampStage s;
    s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
    s.lamp(lamp_m, {0, 0, 1}, LampBeam::of_angle(2 * half_rad));
    s.render();
    const double power = std::log(0.5) / std::log(std::cos(half_rad));
    for (int y = 0; y < 15; ++y)
        for (int x = 0; x < 15; ++x) {
            const Vec3d place_m = s.place(x, y, 3);
            const double cosine = normalized(place_m - lamp_m).z;
            EXPECT_NEAR(s.at(x, y) / plate_radiance(place_m, lamp_m, std::pow(cosine, power)), 1,
                        kSinglePrecision);
        }
    EXPECT_TRUE(s.points.empty());  // it shines away from the camera
}

// Beside the camera: a decimetre away, where rays begin at the plate instead of the camera (60 m), and at ten
// kilometres.
TEST(Lamps, FollowTheInverseSquareFromDecimetresToKilometres) {
    for (const double z_m : {0.1, 1.0, 60.0, 1e4}) {
        const Vec3d lamp_m{0.05, 0, 0};
        LampStage s;
        SceneObject wall = plate(lambert(kWhite), s.grid);
        if (z_m > 100)
            for (Vec3f& vertex : wall.mesh.vertices_m) vertex = 1000.0f * vertex;
        s.add(wall, {0, 0, z_m});
        s.lamp(lamp_m);
        s.render();
        // At 60 m a pixel is the mean of 4 x 4 rays; over its 8 cm the light is straight to 1e-6.
        EXPECT_NEAR(s.center() / plate_radiance(s.place(7, 7, z_m), lamp_m, 1), 1, kSinglePrecision) << z_m;
    }
}

TEST(Lamps, SeveralAddUpAndAreDimmedByTheirLevels) {
    const Vec3d first_m{0.5, 0, 1}, second_m{-1, 0.3, 0.5};
    LampStage s;
    s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
    s.lamp(first_m), s.lamp(second_m);
    s.world.lamps[1].level = 0.25;
    s.render();
    const Vec3d place_m = s.place(7, 7, 3);
    const double expected = plate_radiance(place_m, first_m, 1) + 0.25 * plate_radiance(place_m, second_m, 1);
    EXPECT_NEAR(s.center() / expected, 1, kSinglePrecision);
    EXPECT_EQ(s.stats.lamp_rays, 2u * 15 * 15);
    s.world.lamps[0].level = s.world.lamps[1].level = 0;
    s.render_again();
    EXPECT_EQ(s.center(), 0);
    EXPECT_EQ(s.stats.lamp_rays, 0u);  // off: nothing is asked for
}

TEST(Lamps, ABlockerBetweenShadesAndOneBehindOrUnderTheLampDoesNot) {
    const Vec3d lamp_m{1.5, 0, 1};
    const auto center_with = [&](Vec3d blocker_m, SceneObject blocker) {
        LampStage s;
        s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
        s.add(std::move(blocker), blocker_m);
        s.lamp(lamp_m);
        s.render();
        return s.center();
    };
    const auto box = [] { return cube(lambert(kWhite), Stage().grid, 0.2f); };
    const double free = plate_radiance({0, 0, 3}, lamp_m, 1);
    EXPECT_EQ(center_with({0.75, 0, 2}, box()), 0);
    EXPECT_NEAR(center_with({2.1, 0, 0.2}, box()) / free, 1, kSinglePrecision);      // on the ray's extension
    EXPECT_NEAR(center_with({1.5, 0.3, 1.5}, box()) / free, 1, kSinglePrecision);    // beside it
    EXPECT_NEAR(center_with({1.5, 0, 1 - 0.1}, box()) / free, 1, kSinglePrecision);  // that carries the lamp
}

TEST(Lamps, GlassDimsThemAsItDimsTheSun) {
    MaterialConfig config;
    config.model = kModel<brdf::Glass>;
    config.transmittance = Curve::constant(0.7);
    const Vec3d lamp_m{3, 0, 1};
    LampStage s;
    s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
    s.add(plate(config, s.grid), {1.5, 0, 2});
    s.lamp(lamp_m);
    s.render();
    const Material glass = make_material(config, s.grid);
    const float cosine = 2 / std::sqrt(13.0f);
    const Spectrum passed = sheet_transmittance({&glass, 0, glass.base, glass.highlight}, cosine);
    EXPECT_LT(passed[0], 0.9);
    EXPECT_NEAR(s.center() / (passed[0] * plate_radiance({0, 0, 3}, lamp_m, 1)), 1, 1e-4);
}

// An integrating sphere with its lamp in the middle: every place has the irradiance I / R^2, and sends
// rho E / pi more with each bounce. Its facets lie up to 2.5e-4 of the radius inside the sphere.
TEST(Lamps, AnIntegratingSphereIsAGeometricSeriesInAllPathModels) {
    for (const std::string& model : {std::string("direct"), std::string("path")})
        for (const int depth : {1, 2, 3}) {
            LampStage s;
            s.camera(16, 0.3);
            s.quality.path_model = model;
            s.quality.max_depth = depth;
            s.quality.contribution_threshold = 0;
            const Vec3d middle_m{0.2, 0.1, 0.3};
            s.add(sphere(100, lambert(kWhite), s.grid), middle_m);
            s.lamp(middle_m);
            s.render();
            const int bounces = model == "direct" ? 1 : depth;
            const double series = (1 - std::pow(kWhite, bounces)) / (1 - kWhite);
            double sum = 0;
            for (const float value : s.radiance.plane(0)) sum += value;
            EXPECT_NEAR(sum / static_cast<double>(s.radiance.plane(0).size()) /
                            (kWhite / kPi * kIntensity_w_sr_um * series),
                        1, 2e-3)
                << model << " " << depth;
        }
}

// A ball with a lamp five metres beside it, traced and as points.
TEST(Lamps, WhatIsDrawnAsPointsHasTheFluxThatItHasWhenResolved) {
    const auto intensity_at = [](double distance_m, double half_width, int samples) {
        LampStage s;
        s.camera(256, half_width);
        s.quality.samples_per_axis = samples;
        s.quality.point_samples = 512;
        s.add(sphere(200, lambert(kWhite), s.grid), {0, 0, distance_m});
        s.lamp(Vec3d{3, 0, -4} + Vec3d{0, 0, distance_m}, {-3, 0, 4}, LampBeam::of_angle(1));
        s.render();
        EXPECT_EQ(s.points.empty(), distance_m < 2e4);
        return s.light().irradiance * distance_m * distance_m;
    };
    const double resolved = intensity_at(1e4, 1.05e-4, 4), points = intensity_at(1e5, 0.1, 1);
    EXPECT_GT(resolved, 0);
    // 512 rays across find the area of a round outline to 512^-1.5; the terminator is as smooth as the
    // cosine.
    EXPECT_NEAR(points / resolved, 1, 0.003);
}

TEST(Lamps, OneThatShinesIntoTheCameraIsAPoint) {
    LampStage s;
    s.camera(64, 0.1);
    s.add(cube(lambert(kWhite), s.grid, 0.2f), {0, 0, 5});
    s.lamp({0.1, 0, 4}, {0, 0, -1}, LampBeam::of_angle(60 * kDegree_rad));
    s.lamp({0.05, 0, 4.9}, {0, 0, 1}, LampBeam::of_angle(60 * kDegree_rad));  // away from it
    s.lamp({0, 0, 6});                                                        // behind the cube
    s.render();
    ASSERT_EQ(s.points.size(), 1u);
    const double d2 = 4 * 4 + 0.1 * 0.1;
    const double cosine = 4 / std::sqrt(d2);
    const double power = std::log(0.5) / std::log(std::cos(30 * kDegree_rad));
    EXPECT_NEAR(s.points[0].irradiance_w_m2_um[0] / (kIntensity_w_sr_um * std::pow(cosine, power) / d2), 1,
                kSinglePrecision);
    EXPECT_NEAR(s.points[0].position_px.x, 32 + 320 * 0.1 / 4, 1e-3);
    EXPECT_NEAR(s.points[0].position_px.y, 32, 1e-3);
}

// Two panes across its light; a wall behind the one hides it.
TEST(Lamps, OneIsSeenThroughGlass) {
    MaterialConfig config;
    config.model = kModel<brdf::Glass>;
    config.transmittance = Curve::constant(0.7);
    LampStage s;
    s.camera(64, 0.1);
    s.add(plate(config, s.grid), {0, 0, 5});
    s.add(plate(config, s.grid), {0, 0, 6});
    s.lamp({0, 0, 8}, {0, 0, -1});
    s.render();
    ASSERT_EQ(s.points.size(), 1u);
    const Material glass = make_material(config, s.grid);
    const float passed = sheet_transmittance({&glass, 0, glass.base, glass.highlight}, 1)[0];
    EXPECT_LT(passed, 0.9);
    EXPECT_NEAR(s.points[0].irradiance_w_m2_um[0] / (passed * passed * kIntensity_w_sr_um / 64), 1,
                kSinglePrecision);
    s.add(plate(lambert(kWhite), s.grid), {0, 0, 7});
    s.render();
    EXPECT_TRUE(s.points.empty());
}

TEST(Lamps, OneBehindAThingThatIsDrawnAsPointsIsHidden) {
    for (const double z_m : {-1.5, 1.5}) {
        LampStage s;
        s.camera(64, 0.1);
        s.add(sphere(50, lambert(kWhite), s.grid), {0, 0, 1e5});
        s.lamp({0, 0, 1e5 + z_m});
        s.render();
        const auto lamps = std::count_if(s.points.begin(), s.points.end(),
                                         [](const PointSource& p) { return p.object == PointSource::kSky; });
        EXPECT_EQ(lamps, z_m < 0 ? 1 : 0);
    }
}

// On the very surface: bright, but a number everywhere.
TEST(Lamps, AtNoDistanceTheyStillGiveNumbers) {
    for (const double before_m : {0.0, 1e-12, 1e-7, 1e-4, 1e-3}) {
        LampStage s;
        s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
        s.lamp({0, 0, 3 - before_m});
        s.render();
        for (const float value : s.radiance.plane(0)) {
            EXPECT_TRUE(std::isfinite(value)) << before_m;
            EXPECT_GE(value, 0);
            // That of a millimetre's distance at most.
            EXPECT_LE(value, 1.001 * kWhite / kPi * kIntensity_w_sr_um * 1e6);
        }
    }
}

TEST(LampBeam, HasHalfItsIntensityAtTheEdgeOfItsBeam) {
    const Vec3d axis{0, 0, 1};
    const auto off_axis = [](double rad) { return Vec3d{std::sin(rad), 0, std::cos(rad)}; };
    for (const double full_deg : {0.1, 1.0, 30.0, 120.0, 179.0}) {
        const LampBeam beam = LampBeam::of_angle(full_deg * kDegree_rad);
        EXPECT_EQ(beam.at(axis, axis), 1);
        EXPECT_NEAR(beam.at(axis, off_axis(0.5 * full_deg * kDegree_rad)), 0.5, 1e-9) << full_deg;
        EXPECT_EQ(beam.at(axis, off_axis(kPi)), 0);
        EXPECT_EQ(beam.at(axis, off_axis(2)), 0);
    }
    // Lambert's cosine.
    EXPECT_NEAR(LampBeam::of_angle(120 * kDegree_rad).at(axis, off_axis(1)), std::cos(1), 1e-12);
    EXPECT_EQ(LampBeam().at(axis, off_axis(3)), 1);
    const LampBeam measured = LampBeam::of_table({{0, 0.2, 0.4}, {1, 1.2, 0.2}});
    EXPECT_NEAR(measured.at(axis, off_axis(0.1)), 1.1, 1e-12);
    EXPECT_NEAR(measured.at(axis, off_axis(0.3)), 0.7, 1e-12);
    EXPECT_EQ(measured.at(axis, off_axis(0.41)), 0);
}

TEST(Lamps, ThePlanSaysWhichCost) {
    LampStage s;
    s.add(plate(lambert(kWhite), s.grid), {0, 0, 3});
    s.lamp({0, 0, 1}), s.lamp({0, 0, 2}), s.lamp({0, 0, 2.5});
    s.world.lamps[1].level = 0;
    s.scene.lamps[2].intensity_w_sr_um = {};  // of other wavelengths
    s.render();
    std::string all;
    for (const std::string& line : s.renderer->explain_plan(s.world)) all += line + "\n";
    EXPECT_NE(all.find("lamp 1 'lamp': lit, 1 m from the camera"), std::string::npos) << all;
    EXPECT_NE(all.find("lamp 2 'lamp': off"), std::string::npos) << all;
    EXPECT_NE(all.find("lamp 3 'lamp': dark, as its spectrum"), std::string::npos) << all;
}

}  // namespace
}  // namespace hilcam
