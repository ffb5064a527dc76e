// How numbers of a campaign are drawn: distributions, places, attitudes.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "emulator/campaign/case_plan.h"
#include "emulator/campaign/draw_source.h"
#include "emulator/campaign/number_draw.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Abramowitz & Stegun, Handbook of Mathematical Functions, table 26.5, and 26.2.
TEST(NumberDraw, NormalQuantilesAreThoseOfTheTables) {
    EXPECT_NEAR(normal_quantile(0.5), 0, 1e-12);
    EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
    EXPECT_NEAR(normal_quantile(0.01), -2.326347874040841, 1e-12);
    EXPECT_NEAR(normal_quantile(1e-9), -5.997807015007687, 1e-9);
}

TEST(NumberDraw, EachDistributionIsTheInverseOfItsCumulativeFunction) {
    NumberDraw uniform;
    uniform.uniform = {2, 6}, uniform.has_uniform = true;
    EXPECT_DOUBLE_EQ(number_at(uniform, 0.25), 3);
    NumberDraw logarithmic;
    logarithmic.log_uniform = {1, 100}, logarithmic.has_log_uniform = true;
    EXPECT_NEAR(number_at(logarithmic, 0.5), 10, 1e-12);
    NumberDraw normal;
    normal.normal = {10, 2}, normal.has_normal = true;
    EXPECT_NEAR(number_at(normal, 0.975), 10 + 2 * 1.959963984540054, 1e-11);
    NumberDraw chosen;
    chosen.choice = {5, 7, 9}, chosen.has_choice = true;
    EXPECT_EQ(number_at(chosen, 0.1), 5);
    EXPECT_EQ(number_at(chosen, 0.5), 7);
    EXPECT_EQ(number_at(chosen, 1 - 0x1p-53), 9);
}

TEST(DrawSource, RadicalInversesMirrorTheDigits) {
    EXPECT_DOUBLE_EQ(radical_inverse(1, 2), 0.5);
    EXPECT_DOUBLE_EQ(radical_inverse(6, 2), 0.375);    // 110 -> 0.011
    EXPECT_DOUBLE_EQ(radical_inverse(5, 3), 7.0 / 9);  // 12 -> 0.21
    EXPECT_DOUBLE_EQ(radical_inverse(0, 5), 0);
}

// The power of one dimension is 1 over the golden ratio.
TEST(DrawSource, TheRSequenceOfOneDimensionStepsByTheGoldenRatio) {
    const DrawSource source(3, DrawSequence::kRSequence, 1);
    const double step = source.place(8, 0, 0) - source.place(7, 0, 0);
    EXPECT_NEAR(step - std::floor(step), 0.6180339887498949, 1e-12);
}

TEST(DrawSource, APlaceDependsOnNothingButSeedCaseTryAndDimension) {
    for (const DrawSequence sequence :
         {DrawSequence::kRandom, DrawSequence::kHalton, DrawSequence::kRSequence}) {
        const DrawSource a(42, sequence, 5), b(42, sequence, 5), other(43, sequence, 5);
        for (std::uint64_t n : {1ull, 999ull, 1'000'000ull})
            for (std::size_t d = 0; d < 5; ++d) {
                EXPECT_EQ(a.place(n, 0, d), b.place(n, 0, d));
                EXPECT_NE(a.place(n, 0, d), other.place(n, 0, d));
                EXPECT_NE(a.place(n, 0, d), a.place(n, 1, d));
                EXPECT_GT(a.place(n, 0, d), 0);
                EXPECT_LT(a.place(n, 0, d), 1);
            }
        EXPECT_EQ(a.seed_of_case(5), b.seed_of_case(5));
        EXPECT_NE(a.seed_of_case(5), a.seed_of_case(6));
    }
}

// Greatest distance between the share of places below x and x (Kolmogorov's statistic).
double unevenness(const DrawSource& source, std::size_t dimension, std::size_t count) {
    std::vector<double> places;
    for (std::size_t n = 1; n <= count; ++n) places.push_back(source.place(n, 0, dimension));
    std::sort(places.begin(), places.end());
    double most = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double n = static_cast<double>(count);
        most = std::max({most, std::abs(places[i] - static_cast<double>(i) / n),
                         std::abs(places[i] - static_cast<double>(i + 1) / n)});
    }
    return most;
}

// The unevenness of random places is below 1.95 / sqrt(n) but for one source in a thousand (Kolmogorov), and
// sqrt(pi / 2) ln 2 / sqrt(n) on average; one random source in a hundred has half of that or less. A source that were uniform on
// nine tenths of the interval would have 0.1.
TEST(DrawSource, PlacesAreUniformAndThoseOfSequencesMoreEvenThanChance) {
    constexpr std::size_t kCount = 4000;
    const DrawSource random(7, DrawSequence::kRandom, 6), halton(7, DrawSequence::kHalton, 6),
        r(7, DrawSequence::kRSequence, 6);
    for (std::size_t d = 0; d < 6; ++d) {
        EXPECT_LT(unevenness(random, d, kCount), 1.95 / std::sqrt(4000.0));
        const double chance = std::sqrt(kPi / 2) * std::log(2.0) / std::sqrt(4000.0);
        EXPECT_LT(unevenness(halton, d, kCount), chance / 2);
        EXPECT_LT(unevenness(r, d, kCount), chance / 2);
    }
}

TEST(DrawSource, TooManyDimensionsForHaltonAreRefused) {
    EXPECT_THROW(DrawSource(1, DrawSequence::kHalton, 25), InputError);
    DrawSource(1, DrawSequence::kRSequence, 25);
}

// The turn of attitudes that are even over SO(3) has the density (1 - cos a) / pi, so the mean of its cosine is -1/2 and
// the mean of any entry of the matrix is 0, with variance 1/3. 4.5 standard errors.
TEST(CasePlan, AttitudesAreEvenOverAllRotations) {
    const DrawSource source(11, DrawSequence::kRandom, 3);
    constexpr int kCount = 20000;
    Mat3d sum{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    double cosine = 0;
    for (std::uint64_t n = 1; n <= kCount; ++n) {
        const Quat q = attitude_at(source.place(n, 0, 0), source.place(n, 0, 1), source.place(n, 0, 2));
        EXPECT_NEAR(norm(q), 1, 1e-12);
        const Mat3d m = to_matrix(q);
        sum.x = sum.x + m.x, sum.y = sum.y + m.y, sum.z = sum.z + m.z;
        cosine += 0.5 * (m.x.x + m.y.y + m.z.z - 1);
    }
    const double tolerance = 4.5 / std::sqrt(3.0 * kCount);
    for (const Vec3d row : {sum.x, sum.y, sum.z})
        for (const double entry : {row.x, row.y, row.z}) EXPECT_NEAR(entry / kCount, 0, tolerance);
    // The variance of the cosine is E[cos^2] - 1/4 = 1/2 - 1/4.
    EXPECT_NEAR(cosine / kCount, -0.5, 4.5 * 0.5 / std::sqrt(1.0 * kCount));
}

TEST(CasePlan, DirectionsAreEvenOverTheSphere) {
    const DrawSource source(12, DrawSequence::kRandom, 2);
    constexpr int kCount = 20000;
    Vec3d sum, squares;
    for (std::uint64_t n = 1; n <= kCount; ++n) {
        const Vec3d v = direction_at(source.place(n, 0, 0), source.place(n, 0, 1));
        EXPECT_NEAR(length(v), 1, 1e-12);
        sum = sum + v;
        squares = squares + Vec3d{v.x * v.x, v.y * v.y, v.z * v.z};
    }
    // The variance of a component is 1/3, that of its square 1/5 - 1/9.
    for (const double mean : {sum.x / kCount, sum.y / kCount, sum.z / kCount})
        EXPECT_NEAR(mean, 0, 4.5 / std::sqrt(3.0 * kCount));
    for (const double mean : {squares.x / kCount, squares.y / kCount, squares.z / kCount})
        EXPECT_NEAR(mean, 1.0 / 3, 4.5 * std::sqrt((1.0 / 5 - 1.0 / 9) / kCount));
}

}  // namespace
}  // namespace hilcam
