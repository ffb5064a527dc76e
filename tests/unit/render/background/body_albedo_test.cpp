// What a body without a model sends up again to the air above it.

#include "render/background/body_albedo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

const SpectralGrid kGrid({0.50, 0.57, 0.60, 0.67});

SceneBody body(const BodyConfig& config) {
    SceneBody out;
    out.look = BodyLook(BodyId::kEarth, config, kGrid);
    return out;
}

TEST(BodyAlbedo, OneAlbedoIsOneCell) {
    BodyConfig config = default_body(BodyId::kEarth);
    config.albedo = Curve::constant(0.4);
    const AirGround ground = body_albedo(body(config), kGrid);
    ASSERT_EQ(ground.albedo.size(), 1u);
    EXPECT_FLOAT_EQ(ground.albedo.front()[0], 0.4f);
}

// Lommel-Seeliger's sphere of single-scattering albedo w: 2/3 (1 - ln 2) w of the light comes back, whatever the phase integral
// goes over (Hapke, Theory of Reflectance and Emittance Spectroscopy, 2012, sec. 11.3).
TEST(BodyAlbedo, AnotherLawCountsByItsSphericalAlbedo) {
    BodyConfig config = default_body(BodyId::kEarth);
    config.law = SurfaceLaw::kLommelSeeliger, config.albedo = Curve::constant(0.3);
    EXPECT_NEAR(body_albedo(body(config), kGrid).albedo.front()[0], 0.3 * 2 / 3 * (1 - std::log(2.0)), 5e-4);
}

// A map with a white half in the east: 255 is 1, times the albedo.
TEST(BodyAlbedo, AMapCountsByPlace) {
    BodyConfig config = default_body(BodyId::kEarth);
    config.albedo = Curve::constant(0.8);
    SceneBody earth = body(config);
    Texture picture;
    picture.width = 256, picture.height = 128;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::uint8_t code = x < picture.width / 2 ? 0 : 255;
            picture.texels.push_back({code, code, code});
        }
    earth.map = MipTexture(std::move(picture));
    const AirGround ground = body_albedo(earth, kGrid);
    ASSERT_EQ(ground.albedo.size(), static_cast<std::size_t>(ground.width * ground.height));
    const auto row = static_cast<std::size_t>(ground.height / 2 * ground.width);
    EXPECT_NEAR(ground.albedo[row + static_cast<std::size_t>(ground.width / 4)][0], 0, 1e-3);
    EXPECT_NEAR(ground.albedo[row + static_cast<std::size_t>(3 * ground.width / 4)][2], 0.8, 1e-3);
}

}  // namespace
}  // namespace hilcam
