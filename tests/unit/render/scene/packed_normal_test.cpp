#include "render/scene/packed_normal.h"

#include <gtest/gtest.h>

#include <random>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

TEST(Surface, PackedNormalsAreGoodToFourThousandthsOfADegree) {
    std::mt19937 engine(1);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 10000; ++i) {
        const Vec3f n = normalized(Vec3f{normal(engine), normal(engine), normal(engine)});
        const double sine = length(cross(to_double(n), to_double(unpack_normal(pack_normal(n)))));
        // Cigolle et al., JCGT 3(2), 2014, table 2: 0.0037 degrees at most with 2 x 16 bits.
        EXPECT_LT(sine, 0.004 * kDegree_rad);
        EXPECT_GT(dot(n, unpack_normal(pack_normal(n))), 0);
    }
}

}  // namespace
}  // namespace hilcam
