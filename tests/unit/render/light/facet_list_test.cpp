#include "render/light/facet_list.h"

#include <gtest/gtest.h>

#include "render/scene/material.h"

namespace hilcam {
namespace {

// Two facets in a pixel, as large and as much in the light: the one in its right half mirrors it to the viewer. So that is where
// light comes from, and where rays begin that ask for shadows.
TEST(FacetList, LightComesFromTheFacetThatReflectsIt) {
    MaterialConfig config;
    config.model = kModel<brdf::Metal>;
    config.reflectance = Curve::constant(0.9);
    config.roughness = 0.2;
    const Material metal = make_material(config, SpectralGrid({0.5, 0.6}));
    FrameView frame;
    frame.world_from_body = {Mat3f{}};
    frame.samples = PixelSamples(8);
    constexpr SampleMask kLeft = 0x0000FFFF0000FFFF, kRight = ~kLeft;
    const Vec3f up{0, 0, 1}, view = normalized(Vec3f{0.4f, 0, 1}), dir = normalized(Vec3f{-0.4f, 0, 1});
    // Both meet the light at one angle.
    const Facet left{up, normalized(Vec3f{0, 0.4f, 1}), {}, 8, kLeft},
        right{up, up, {}, 8, kRight, nullptr, &left};
    Vertex at{};
    at.view_dir = view, at.normal = up, at.geometric_normal = up;
    at.weight.bin.fill(1);
    at.facets = &right;
    const Scatterer surface{&metal, metal.ggx_alpha, metal.base, metal.highlight};
    const FacetLight light = lit_facets(frame, at, surface, dir);
    EXPECT_EQ(light.brightest[0], &right);
    EXPECT_GT(light.share[0], 100 * light.share[1]);
    EXPECT_NEAR(light.halves.across, 1, 0.02);
    EXPECT_NEAR(light.halves.down, 0, 1e-6);
}

}  // namespace
}  // namespace hilcam
