#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

std::vector<SideLight> lights_of(Stage& s) {
    std::vector<SideLight> lights;
    s.renderer->find_side_light(lights);
    return lights;
}
double total(const std::vector<SideLight>& lights) {
    double sum = 0;
    for (const SideLight& light : lights) sum += static_cast<double>(light.irradiance_w_m2_um[0]);
    return sum;
}

TEST(SideLight, TheSunBesideTheFieldIsAllThereAndInItIsNot) {
    Stage s;
    s.sun({0.9, 0, 0.5});  // the field ends at 32 degrees
    s.render();
    const std::vector<SideLight> lights = lights_of(s);
    EXPECT_NEAR(total(lights) / static_cast<double>(kSun_w_m2_um), 1, 1e-4);
    for (const SideLight& light : lights) {
        EXPECT_NEAR(static_cast<double>(length(light.camera_dir)), 1, 1e-6);
        EXPECT_NEAR(static_cast<double>(light.camera_dir.x / light.camera_dir.z), 1.8, 0.05);
    }
    s.sun({0, 0, 1});
    s.render();
    EXPECT_TRUE(lights_of(s).empty());
}

// The limb of the image (its guard band, too) cuts the disk.
TEST(SideLight, APartOfTheSunIsWhereThePictureEnds) {
    Stage s;
    const double edge = std::atan(20.0 / 32);
    s.sun({std::sin(edge), 0, std::cos(edge)});
    s.render();
    EXPECT_NEAR(total(lights_of(s)) / static_cast<double>(kSun_w_m2_um), 0.5, 0.15);
}

TEST(SideLight, AnObjectAndABodyKeepItOff) {
    Stage s;
    s.sun({1, 0, 0});
    s.add(plate(lambert(0.5), s.grid), {3, 0, 0}, {0, 0.5 * kPi, 0});
    s.render();
    EXPECT_EQ(total(lights_of(s)), 0);
    s.sun({-1, 0, 0});
    s.render();
    EXPECT_NEAR(total(lights_of(s)) / static_cast<double>(kSun_w_m2_um), 1, 1e-4);
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {-1e7, 0, 0};
    s.render();
    EXPECT_NEAR(total(lights_of(s)), 0, 1e-3);  // its night side is black
}

// A Lambert sphere at full phase gives 2/3 A (R / d)^2 of the Sun's irradiance, far away.
TEST(SideLight, AFullEarthGivesItsIrradiance) {
    Stage s;
    s.earth(0.3);
    const double d = 3e8, radius_m = kEarthEquatorialRadius_m;
    s.world.bodies[BodyId::kEarth].world_m = {d, 0, 0};
    s.sun({-1, 0.02, 0});
    s.render();
    double earth = 0;
    for (const SideLight& light : lights_of(s))
        if (light.camera_dir.x > 0) earth += static_cast<double>(light.irradiance_w_m2_um[0]);
    EXPECT_NEAR(earth / (2.0 / 3 * 0.3 * std::pow(radius_m / d, 2) * static_cast<double>(kSun_w_m2_um)), 1,
                0.01);
}

}  // namespace
}  // namespace hilcam
