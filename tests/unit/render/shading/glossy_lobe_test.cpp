#include "render/shading/glossy_lobe.h"

#include <gtest/gtest.h>

#include <array>

namespace hilcam {
namespace {

Spectrum gray(float light) {
    Spectrum out;
    out.bin.fill(light);
    return out;
}

// Each of `bright` rays brings a share of the light.
GlossyLobe lobe_of(float cached, float directions, float light, std::size_t bright) {
    GlossyLobe lobe;
    lobe.cached = cached, lobe.cached_directions = directions;
    for (std::size_t i = 0; i < bright; ++i) lobe.add(i, gray(light / static_cast<float>(bright)));
    return lobe;
}
float found(const GlossyLobe& lobe) { return max_component(lobe.sum(lobe.believed())); }

TEST(GlossyLobe, RaysAreRightWhereTheyFindLess) {
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 3, 1)), 3);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 0, 0)), 0);
}

TEST(GlossyLobe, ARayThatMeetsAGlintIsBelievedAsADirectionIs) {
    EXPECT_FLOAT_EQ(found(lobe_of(10, 1, 30, 1)), 20);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 30, 1)), 14);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 30, 4)), 20);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 30, 16)), 26);
}

// Nothing is kept that rays could be held against.
TEST(GlossyLobe, RaysAloneAreRight) { EXPECT_FLOAT_EQ(found(lobe_of(0, 0, 30, 1)), 30); }

TEST(GlossyLobe, LightOfTheSkyIsAsItIs) {
    GlossyLobe lobe = lobe_of(10, 1, 30, 1);
    lobe.sky = gray(5);
    EXPECT_FLOAT_EQ(found(lobe), 25);
}

// A ray's light comes in parts, from all that it meets.
// The tail of a lamp's beam may be so faint that its square is nothing.
TEST(GlossyLobe, FaintLightIsANumber) {
    for (const float light : {1e-18f, 1e-24f, 1e-40f}) {
        const GlossyLobe lobe = lobe_of(0.1f * light, 4, light, 3);
        EXPECT_GT(found(lobe), 0.1f * light) << light;
        EXPECT_LE(found(lobe), light) << light;
    }
}

TEST(GlossyLobe, PartsOfOneRayAreOne) {
    GlossyLobe lobe = lobe_of(10, 1, 20, 1);
    lobe.add(0, gray(10));
    EXPECT_FLOAT_EQ(found(lobe), 20);
}

// One of three has met a glint: they send what all rays have found, the dark one nothing.
TEST(GlossyLobe, WhatOneDoesNotHaveOthersHave) {
    const std::array lobes{lobe_of(10, 4, 60, 1), lobe_of(10, 4, 10, 4), lobe_of(10, 4, 0, 0)};
    const float share = found_over_believed(lobes);
    float sum = 0;
    for (const GlossyLobe& lobe : lobes) sum += max_component(lobe.sum(share * lobe.believed()));
    EXPECT_FLOAT_EQ(sum, 70);
    EXPECT_FLOAT_EQ(share, 70.0f / 30);
    EXPECT_EQ(lobes[2].believed(), 0);
    EXPECT_EQ(found_over_believed({}), 1);
}

}  // namespace
}  // namespace hilcam
