// The tree's diameter against all pairs, and against forms whose diameter is known.

#include "render/vocabulary/point_diameter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/vocabulary/random.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

std::vector<Vec3d> scattered(std::size_t count, Vec3d size, std::uint64_t seed) {
    std::vector<Vec3d> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto words = random_words({seed, 1}, RandomPurpose::kPathSample, static_cast<std::uint32_t>(i));
        const auto u = [&](std::size_t k) { return static_cast<double>(words[k]) * 0x1p-32 - 0.5; };
        points[i] = {size.x * u(0), size.y * u(1), size.z * u(2)};
    }
    return points;
}

double of_all_pairs(const std::vector<Vec3d>& points) {
    double most = 0;
    for (const Vec3d& a : points)
        for (const Vec3d& b : points) most = std::max(most, length(a - b));
    return most;
}

TEST(PointDiameter, IsThatOfAllPairs) {
    for (const std::size_t count : {2u, 3u, 16u, 17u, 100u, 1500u})
        for (const Vec3d size : {Vec3d{1, 1, 1}, Vec3d{100, 1, 0.01}, Vec3d{1, 1, 0}}) {
            const std::vector<Vec3d> points = scattered(count, size, count);
            EXPECT_DOUBLE_EQ(point_diameter(points), of_all_pairs(points)) << count;
        }
}

TEST(PointDiameter, OfOnePlaceIsNothing) {
    EXPECT_EQ(point_diameter({}), 0);
    EXPECT_EQ(point_diameter(std::vector<Vec3d>{{1, 2, 3}}), 0);
    EXPECT_EQ(point_diameter(std::vector<Vec3d>(100, {1, 2, 3})), 0);
}

// Nearly every point of a sphere has another at its other end: the tree has the least to leave out.
TEST(PointDiameter, OfASphereIsTwiceItsRadius) {
    std::vector<Vec3d> points;
    constexpr int kRows = 200;
    for (int i = 0; i <= kRows; ++i)
        for (int j = 0; j < kRows; ++j) {
            const double polar = kPi * i / kRows, around = 2 * kPi * j / kRows;
            points.push_back({7 * std::sin(polar) * std::cos(around), 7 * std::sin(polar) * std::sin(around),
                              7 * std::cos(polar)});
        }
    EXPECT_NEAR(point_diameter(points), 14, 1e-12);
}

}  // namespace
}  // namespace hilcam
