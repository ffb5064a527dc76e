#include "render/skylight/sky_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// The Earth from low orbit: its cone, air and all, and the margin beside it are not clear.
TEST(SkyLight, KeepsClearOfBodiesByItsMargin) {
    Stage s;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 6.8e6};
    s.sun({0, 1, -1});
    Background background(s.scene.bodies, nullptr, nullptr, s.scene.sun_irradiance_1au_w_m2_um, true, s.grid);
    background.place(s.world, {}, 1e-4);
    constexpr double kMargin_rad = 0.01;
    SkyLight sky(1);
    sky.place(background, static_cast<float>(kMargin_rad));
    ASSERT_FALSE(background.body_lights().empty());
    const BodyLight& earth = background.body_lights().front();
    const double half_rad = std::acos(1 - static_cast<double>(earth.one_minus_cosine));
    EXPECT_GT(half_rad, std::asin(kEarthEquatorialRadius_m / 6.8e6) - 0.003);  // a ball at least
    const auto is_clear = [&](double off_rad) {
        return sky.is_clear_of_bodies(to_float(Vec3d{std::sin(off_rad), 0, std::cos(off_rad)}));
    };
    EXPECT_FALSE(is_clear(0));
    EXPECT_FALSE(is_clear(half_rad));
    EXPECT_FALSE(is_clear(half_rad + 0.9 * kMargin_rad));
    EXPECT_TRUE(is_clear(half_rad + 1.1 * kMargin_rad));
    EXPECT_TRUE(is_clear(kPi));
}

}  // namespace
}  // namespace hilcam
