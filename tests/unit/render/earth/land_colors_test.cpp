// Colours to reflectances, as tools/make_earth_map.py has it: tests/sky/earth_map_tool_test.py has the same figures.

#include "render/earth/land_colors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

TEST(LandColors, AreTheToolsOwn) {
    struct Case {
        Vec3f color;
        BandReflectances bands;  // blue, green, red, near infrared
    };
    const Case cases[] = {
        {{0.0096f, 0.0207f, 0.0032f}, {0.02f, 0.045f, 0.029f, 0.4f}},
        {{0.616f, 0.449f, 0.248f}, {0.25f, 0.35f, 0.46f, 0.58f}},
        {{0.89f, 0.92f, 0.93f}, {0.975f, 0.98f, 0.975f, 0.93f}},
        {{0.05f, 0.06f, 0.02f}, {0.05796f, 0.09148f, 0.08678f, 0.24687f}},
        {{0.3f, 0.2f, 0.1f}, {0.14755f, 0.20414f, 0.28525f, 0.35967f}},
        {{0.7f, 0.72f, 0.7f}, {0.72771f, 0.68933f, 0.59717f, 0.57005f}},
    };
    for (const Case& c : cases) {
        const BandReflectances found = bands_of_blue_marble(c.color);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], c.bands[i], 3e-5f) << c.color.x << " " << i;
    }
}

TEST(LandColors, StayWithinZeroAndOne) {
    for (const float value : {-1.0f, 0.0f, 1e-9f, 0.5f, 1.0f, 100.0f})
        for (const BandReflectances& bands :
             {bands_of_blue_marble({value, value, value}), bands_of_reflectances({value, 0, value}),
              bands_of_reflectances({0, value, 0})})
            for (const float band : bands) {
                EXPECT_GE(band, 0);
                EXPECT_LE(band, 1);
            }
}

}  // namespace
}  // namespace hilcam
