#include <gtest/gtest.h>

#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

// Known answers of Random123's kat_vectors for philox4x32-10 (Salmon et al., 2011): key 0, counter 0. Purpose
// 0 is not a stream of ours, so the words are asked for with a cast.
TEST(Random, IsPhiloxAsPublished) {
    const auto w = random_words({0, 0}, static_cast<RandomPurpose>(0), 0, 0);
    EXPECT_EQ(w[0], 0x6627e8d5u);
    EXPECT_EQ(w[1], 0xe169c58du);
    EXPECT_EQ(w[2], 0xbc57ac4cu);
    EXPECT_EQ(w[3], 0x9b00dbd8u);
}

TEST(Random, UniformNeverReachesItsEnds) {
    EXPECT_GT(uniform01(0), 0.0f);
    EXPECT_LT(uniform01(0xFFFFFFFFu), 1.0f);
}

}  // namespace
}  // namespace hilcam
