// What the surface probes meet (transfer_table.h): nothing that has no light, and of what has some the share that
// formulas say.

#include "render/probes/transfer_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Inside a closed body there is no light to keep, unless lamps may be there; outside everything is free.
TEST(TransferTable, LeavesOutWhatNoLightReaches) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject box = cube(lambert(0.5), grid);
    const std::vector<std::uint8_t> glass(1);
    const TransferTable outside(box.mesh, glass, {60, 2000, false});
    const TransferTable both(box.mesh, glass, {60, 2000, true});
    EXPECT_GT(outside.size(), 500u);
    EXPECT_EQ(outside.entries(), 0u);
    EXPECT_NEAR(static_cast<double>(both.size()) / static_cast<double>(outside.size()), 2, 0.1);
    EXPECT_TRUE(outside.is_whole() && both.is_whole());
    ProbeWeights about;
    EXPECT_TRUE(outside.probes().find({0.5f, 0.1f, 0.2f}, {{1, 0, 0}, 0, false}, about));
    EXPECT_GT(about.count, 0);
    EXPECT_TRUE(outside.probes().find({0.5f, 0.1f, 0.2f}, {{-1, 0, 0}, 0, true}, about));
    EXPECT_EQ(about.count, 0);
    EXPECT_FALSE(outside.probes().find({3, 3, 3}, {{1, 0, 0}, 0, false}, about));
}

// Two parallel squares a side apart: each sends the other 0.1998 of what leaves it (Howell, Menguc & Siegel,
// Thermal Radiation Heat Transfer, configuration factor C-11).
TEST(TransferTable, ParallelSquaresMeetTheirViewFactor) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject plates =
        object_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                  {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}, lambert(0.5), grid);
    for (const int directions : {16, 60, 256}) {
        const TransferTable table(plates.mesh, std::vector<std::uint8_t>(1), {directions, 3000, false});
        // Entries belong to the inner sides alone, which are half of the probes.
        const double factor =
            static_cast<double>(table.entries()) / (0.5 * static_cast<double>(table.size()) * directions);
        EXPECT_NEAR(factor / 0.1998, 1, directions == 16 ? 0.06 : 0.04) << directions;
    }
}

// Returns the share of a half sphere's irradiance that a square of 0.3 m, 1 m above the origin, fills at a place on
// the plane below it: the sum of cos^2 / (pi r^2) over it.
double share_of_square(double x_m, double y_m) {
    constexpr int kParts = 8;
    constexpr double kSide_m = 0.3, kPart_m = kSide_m / kParts;
    double sum = 0;
    for (int i = 0; i < kParts; ++i)
        for (int k = 0; k < kParts; ++k) {
            const double dx = (i + 0.5) * kPart_m - 0.5 * kSide_m - x_m;
            const double dy = (k + 0.5) * kPart_m - 0.5 * kSide_m - y_m;
            const double square = 1 + dx * dx + dy * dy;
            sum += kPart_m * kPart_m / (kPi * square * square);
        }
    return sum;
}

// Places side by side see a small thing each by its own chance, so that their mean is right: over squares of
// 0.2 m of a floor, some 25 places each, the number of directions that meet a square above scatters as chance has
// it, or less. (It scattered by 4 times as much when places side by side had nearly the same directions.)
TEST(TransferTable, PlacesSideBySideLookElsewhere) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject room = object_of({{-2, -2, 0},
                                        {2, -2, 0},
                                        {2, 2, 0},
                                        {-2, 2, 0},
                                        {-0.15f, -0.15f, 1},
                                        {0.15f, -0.15f, 1},
                                        {0.15f, 0.15f, 1},
                                        {-0.15f, 0.15f, 1}},
                                       {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}, lambert(0.5), grid);
    const TransferTable table(room.mesh, std::vector<std::uint8_t>(1), {60, 20'000, false});
    constexpr int kAcross = 20;
    std::vector<double> met(kAcross * kAcross), expected(kAcross * kAcross);
    for (std::size_t n = 0; n < table.size(); ++n) {
        const SurfaceProbe& probe = table.probes().probes()[n];
        const Vec3f place_m = probe.point_m[0];
        if (place_m.z > 0.5f || unpack_normal(probe.mean_normal).z < 0.5f) continue;
        const auto column = static_cast<std::size_t>((place_m.x + 2) * 5),
                   row = static_cast<std::size_t>((place_m.y + 2) * 5);
        const std::size_t at =
            std::min<std::size_t>(row, kAcross - 1) * kAcross + std::min<std::size_t>(column, kAcross - 1);
        met[at] += static_cast<double>(table.entries(n).size());
        expected[at] += 60 * share_of_square(place_m.x, place_m.y);
    }
    double sum = 0;
    int squares = 0;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (expected[i] > 5) sum += (met[i] - expected[i]) * (met[i] - expected[i]) / expected[i], ++squares;
    EXPECT_GT(squares, 100);
    EXPECT_LT(sum / squares, 1.2);
}

// Meshes that no one would draw: without area, with holes, with the normals inwards, with a sliver.
TEST(TransferTable, TakesWhatMeshesThereAre) {
    const SpectralGrid grid{{0.5, 0.6}};
    const std::vector<std::uint8_t> glass(1);
    const SceneObject point = object_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}, lambert(0.5), grid);
    EXPECT_EQ(TransferTable(point.mesh, glass, {60, 2000, false}).size(), 0u);
    const SceneObject sliver =
        object_of({{0, 0, 0}, {1000, 0, 0}, {1000, 1e-4f, 0}}, {{0, 1, 2}}, lambert(0.5), grid);
    EXPECT_GT(TransferTable(sliver.mesh, glass, {60, 2000, false}).size(), 0u);
    SceneObject open = cube(lambert(0.5), grid);
    for (auto& t : open.mesh.triangles) std::swap(t[1], t[2]);
    open.mesh.triangles.pop_back(), open.mesh.surface_of_triangle.pop_back();
    const TransferTable table(open.mesh, glass, {60, 2000, false});
    EXPECT_GT(table.entries(), 0u);
    EXPECT_TRUE(table.is_whole());
}

}  // namespace
}  // namespace hilcam
