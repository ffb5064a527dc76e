#include "render/visibility/pixel_samples.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hilcam {
namespace {

double squared(Vec2f a, Vec2f b) {
    const double x = static_cast<double>(a.x - b.x), y = static_cast<double>(a.y - b.y);
    return x * x + y * y;
}

// The middle of a set of samples is the place of the sample nearest to their mean.
TEST(PixelSamples, TheMiddleIsTheSampleNearestToIt) {
    std::mt19937_64 engine(3);
    for (const int across : {4, 8}) {
        const PixelSamples grid(across);
        for (int round = 0; round < 2000; ++round) {
            // Sparse sets and dense ones, of which few have a sample about their middle and most.
            SampleMask samples = engine() & grid.all();
            for (int thinner = round % 4; thinner > 0; --thinner) samples &= engine();
            if (samples == 0 || samples == grid.all()) continue;
            Vec2f sum{};
            int count = 0;
            for (int i = 0; i < across * across; ++i)
                if (samples >> i & 1u) sum.x += grid.place(i).x, sum.y += grid.place(i).y, ++count;
            const Vec2f middle{sum.x / static_cast<float>(count), sum.y / static_cast<float>(count)};
            const Vec2f found = grid.middle(samples);
            double least = std::numeric_limits<double>::infinity();
            bool is_one = false;
            for (int i = 0; i < across * across; ++i) {
                if (!(samples >> i & 1u)) continue;
                least = std::min(least, squared(grid.place(i), middle));
                is_one = is_one || squared(grid.place(i), found) == 0;
            }
            EXPECT_TRUE(is_one) << across << ' ' << samples;
            EXPECT_NEAR(squared(found, middle), least, 1e-6) << across << ' ' << samples;
        }
        EXPECT_EQ(squared(grid.middle(grid.all()), {0.5f, 0.5f}), 0);
    }
}

TEST(PixelSamples, EachFourAcrossHaveOneInEveryRowAndColumn) {
    for (const int across : {4, 8}) {
        const PixelSamples grid(across);
        SampleMask rest = 0;
        for (int round = 0; round < 5; ++round) {  // the last begins anew
            unsigned rows = 0, columns = 0;
            for (int i = 0; i < 4; ++i) {
                const Vec2f at = grid.place(next_sample_across(grid, rest, grid.all()));
                columns |= 1u << static_cast<unsigned>(4 * at.x),
                    rows |= 1u << static_cast<unsigned>(4 * at.y);
            }
            EXPECT_EQ(rows, 15u) << across << ' ' << round;
            EXPECT_EQ(columns, 15u) << across << ' ' << round;
        }
    }
}

}  // namespace
}  // namespace hilcam
