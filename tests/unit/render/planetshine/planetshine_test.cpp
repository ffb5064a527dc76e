#include "render/planetshine/planetshine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/brdf/microfacet.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// The Earth along +z, a ball of one albedo.
struct EarthAhead {
    Stage s;
    Background background;

    EarthAhead(double distance_m, Vec3d to_sun)
        : s(stage(distance_m, to_sun)),
          background(s.scene.bodies, nullptr, nullptr, s.scene.sun_irradiance_1au_w_m2_um, true, s.grid) {
        background.place(s.world, {}, 1e-4);
    }

  private:
    static Stage stage(double distance_m, Vec3d to_sun) {
        Stage s;
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, distance_m};
        s.sun(to_sun);
        return s;
    }
};

// The Earth from low orbit: its cone, air and all, and the margin beside it are not clear.
TEST(Planetshine, KeepsClearOfBodiesByItsMargin) {
    const EarthAhead earth_ahead(6.8e6, {0, 1, -1});
    const Background& background = earth_ahead.background;
    constexpr double kMargin_rad = 0.01;
    Planetshine sky(1);
    sky.place(background, static_cast<float>(kMargin_rad));
    ASSERT_FALSE(background.planetshine_sources().empty());
    const PlanetshineSource& earth = background.planetshine_sources().front();
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

// The whole Earth from a geostationary orbit, in lobes about its middle and beside it: what a sum over twenty thousand
// directions of a spiral has.
TEST(Planetshine, WideLobesHaveTheLightOfADisk) {
    const EarthAhead earth(4.2164e7, {0, 0.3, -1});
    const Background& background = earth.background;
    Planetshine sky(0.1f);
    sky.place(background, 0.01f);
    ASSERT_EQ(sky.bodies().size(), 1u);
    const float below = background.planetshine_sources().front().one_minus_cosine;
    for (const float alpha : {0.15f, 0.2f, 0.3f, 0.5f})
        for (const float off_rad : {0.0f, 0.1f, 0.2f, 0.4f}) {
            const Vec3f normal = normalized(Vec3f{0.4f, 0.1f, 1});
            const Vec3f view_dir = reflect(Vec3f{std::sin(off_rad), 0, std::cos(off_rad)}, normal);
            const float no = dot(normal, view_dir);
            constexpr int kDirections = 20000;
            constexpr float kGoldenAngle_rad = 2.3999632f;  // Vogel, Mathematical Biosciences 44, 1979
            double sum = 0;
            for (int i = 0; i < kDirections; ++i) {
                const float lower = below * (static_cast<float>(i) + 0.5f) / kDirections;
                const float around = kGoldenAngle_rad * static_cast<float>(i),
                            r = std::sqrt(lower * (2 - lower));
                const Vec3f dir{r * std::cos(around), r * std::sin(around), 1 - lower};
                Spectrum weight, light;
                weight.bin.fill(2 * kPiF * below / kDirections);
                background.add_bodies({}, to_double(dir), weight, light, 0.001);
                const float nh = dot(normal, normalized(dir + view_dir)), ni = dot(normal, dir);
                sum += static_cast<double>(light[0] * ni * ggx_distribution(alpha, nh) *
                                           ggx_visibility(alpha, no, ni));
            }
            const float found = sky.glossy(0, normal, view_dir, alpha, 1).radiance[0];
            EXPECT_NEAR(static_cast<double>(found) / sum, 1, 0.02) << alpha << " " << off_rad;
        }
}

}  // namespace
}  // namespace hilcam
