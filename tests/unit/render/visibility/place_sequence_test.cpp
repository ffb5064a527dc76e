#include "render/visibility/place_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hilcam {
namespace {

// Every run of 2^k places from a multiple of 2^k on has one in each box of 2^-a by 2^(a-k).
TEST(PlaceSequence, FillsEveryBoxOnce) {
    for (const std::uint32_t first : {0u, 64u, 960u})
        for (int k = 0; k <= 6; ++k)
            for (int a = 0; a <= k; ++a) {
                std::vector<int> boxes(std::size_t{1} << k);
                for (std::uint32_t i = 0; i < 1u << k; ++i) {
                    const auto [x, y] = place_in_sequence(first + i, 0x9E3779B9u, 0xBB67AE85u);
                    const int column = static_cast<int>(std::ldexp(x, a));
                    const int row = static_cast<int>(std::ldexp(y, k - a));
                    ++boxes.at(static_cast<std::size_t>((column << (k - a)) + row));
                }
                EXPECT_EQ(std::count(boxes.begin(), boxes.end(), 1), 1 << k) << first << " " << k << " " << a;
            }
}

}  // namespace
}  // namespace hilcam
