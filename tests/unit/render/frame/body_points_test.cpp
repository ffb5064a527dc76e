// Bodies of a few pixels and below.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

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

}  // namespace
}  // namespace hilcam
