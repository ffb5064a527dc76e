#include "render/light/path_vertex.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

Spectrum gray(float light) {
    Spectrum out;
    out.bin.fill(light);
    return out;
}

// Each of `bright` rays brings a share of the light.
FollowedLobe lobe_of(float kept, float directions, float light, std::size_t bright) {
    FollowedLobe lobe;
    lobe.kept = kept, lobe.kept_directions = directions;
    for (std::size_t i = 0; i < bright; ++i) lobe.add(i, gray(light / static_cast<float>(bright)));
    return lobe;
}
float found(const FollowedLobe& lobe) { return largest(lobe.sum(lobe.believed())); }

TEST(FollowedLobe, RaysAreRightWhereTheyFindLess) {
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 3, 1)), 3);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 0, 0)), 0);
}

// With four directions one ray has as much to say as they have.
TEST(FollowedLobe, OneRayThatMeetsAGlintCountsByHalf) {
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 30, 1)), 20);
    EXPECT_FLOAT_EQ(found(lobe_of(10, 4, 30, 4)), 26);
    EXPECT_NEAR(found(lobe_of(10, 4, 30, 20)), 30, 1);
}

// Nothing is kept that rays could be held against.
TEST(FollowedLobe, RaysAloneAreRight) { EXPECT_FLOAT_EQ(found(lobe_of(0, 0, 30, 1)), 30); }

TEST(FollowedLobe, LightOfTheSkyIsAsItIs) {
    FollowedLobe lobe = lobe_of(10, 4, 30, 1);
    lobe.sky = gray(5);
    EXPECT_FLOAT_EQ(found(lobe), 25);
}

// A ray's light comes in parts, from all that it meets.
TEST(FollowedLobe, PartsOfOneRayAreOne) {
    FollowedLobe lobe = lobe_of(10, 4, 20, 1);
    lobe.add(0, gray(10));
    EXPECT_FLOAT_EQ(found(lobe), 20);
}

}  // namespace
}  // namespace hilcam
