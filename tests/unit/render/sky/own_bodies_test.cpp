#include "render/sky/own_bodies.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A circle of 421 800 km in 1.769 days in ICRF's plane.
OwnBody io() {
    OwnBody body;
    body.name = "io";
    body.figure = {1829.4e3, 1815.7e3};
    body.center = BodyId::kJupiter;
    body.orbit = [](TimeTai time) {
        const double rate = kTurn_rad / (1.769 * 86400),
                     a = rate * static_cast<double>(time.ns % 1'000'000'000'000'000) * 1e-9;
        const double r = 421800e3;
        return StateVector{{r * std::cos(a), r * std::sin(a), 0},
                           {-r * rate * std::sin(a), r * rate * std::cos(a), 0}};
    };
    return body;
}

TEST(OwnBodies, TheyStandWhereTheirOrbitHasThemWhenTheLightLeft) {
    const TimeTai time = parse_utc("2026-03-01T00:00:00Z");
    auto own = std::make_shared<OwnBodies>();
    own->list.push_back(io());
    OriginConfig origin;  // the Earth's centre
    origin.own = own;
    const Bodies seen = bodies_at(time, origin);
    const BodyId first{kBodyCount};
    const Vec3d jupiter_m = seen[BodyId::kJupiter].world_m;
    const TimeTai then = time + -static_cast<std::int64_t>(length(jupiter_m) / kSpeedOfLight_m_s * 1e9);
    const Vec3d about = own->list[0].orbit(then).position_m;
    EXPECT_NEAR(length(seen[first].world_m - jupiter_m - about), 0, 1);
    EXPECT_EQ(seen.figure(first).polar_radius_m, 1815.7e3);
    EXPECT_EQ(seen.figure(BodyId::kJupiter).polar_radius_m,
              kFigures[index_of(BodyId::kJupiter)].polar_radius_m);
    // Its x axis looks at Jupiter, its z along the orbit's pole.
    const Vec3d towards = seen[first].fixed_from_world * normalized(jupiter_m - seen[first].world_m);
    EXPECT_NEAR(towards.x, 1, 1e-12);
    EXPECT_NEAR((seen[first].fixed_from_world * Vec3d{0, 0, 1}).z, 1, 1e-12);
    // From Jupiter itself light takes no time.
    origin.kind = OriginConfig::Kind::kBodyCenter, origin.body = BodyId::kJupiter;
    const Bodies near = bodies_at(time, origin);
    EXPECT_NEAR(length(near[first].world_m - own->list[0].orbit(time).position_m), 0, 1e-3);
}

// The IAU's form of rotation: here the Moon's numbers without its librations.
TEST(OwnBodies, APoleAndARateTurnThem) {
    OwnBody body = io();
    body.synchronous = false;
    body.pole_right_ascension_rad = 268.056595 * kDegree_rad,
    body.pole_declination_rad = 64.495303 * kDegree_rad;
    body.meridian_rad = 284.95 * kDegree_rad, body.rate_rad_s = 870.536 * kDegree_rad / 86400;
    const TimeTai time = parse_utc("2026-03-01T00:00:00Z");
    const Mat3d mine = fixed_from_icrf(body, {}, time),
                jupiters = body_fixed_from_icrf(BodyId::kJupiter, time, EarthOrientation{});
    // Jupiter's pole drifts by 0.002 deg in these years.
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(mine * axis - jupiters * axis), 0, 1e-4);
}

TEST(OwnBodies, TheyAreSeenAndTheirShadowLiesOnTheirPlanet) {
    Stage s;
    s.camera(64, 0.15);
    const BodyId moon{kBodyCount};
    const Vec3d sun = normalized(Vec3d{0.3, 0, -1});
    s.sun(sun);
    s.scene.body(BodyId::kJupiter) = {
        true, BodyLook(BodyId::kJupiter, default_body(BodyId::kJupiter), s.grid), {}};
    s.world.bodies[BodyId::kJupiter].world_m = {0, 0, 1e9};
    s.world.bodies[BodyId::kJupiter].fixed_from_world = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Vec3d moon_m = Vec3d{0, 0, 1e9 - 71492e3} + 3e8 * sun;
    s.world.bodies[moon] = {
        moon_m, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {1.6e7, 1.6e7}};  // 10 px: no points
    const auto at = [&](double x, double y) {
        return static_cast<double>(s.radiance.row(static_cast<int>(y))[static_cast<std::size_t>(x)]);
    };
    const double f = s.geometry.focal_length_px;
    const double x = 32 + f * moon_m.x / moon_m.z, y = 32 + f * moon_m.y / moon_m.z;
    s.render();
    EXPECT_GT(at(32, 32), 1);
    EXPECT_EQ(at(x, y), 0);
    BodyConfig look;
    look.albedo = Curve::constant(0.5);
    s.scene.body(moon) = {true, BodyLook(moon, look, s.grid), {}};
    s.render();
    EXPECT_EQ(at(32, 32), 0);
    EXPECT_GT(at(26, 32), 1);
    EXPECT_NEAR(at(x, y) / (0.5 * static_cast<double>(kSun_w_m2_um) / kPi), 0.98, 0.15);
}

}  // namespace
}  // namespace hilcam
