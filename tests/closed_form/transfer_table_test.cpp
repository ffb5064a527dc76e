// What the places of kept light meet (transfer_table.h): nothing that has no light, and of what has some the share that formulas say.

#include "render/scene/transfer_table.h"

#include <gtest/gtest.h>

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
    NodesAbout about;
    EXPECT_TRUE(outside.nodes().find({0.5f, 0.1f, 0.2f}, {{1, 0, 0}, 0, false}, about));
    EXPECT_GT(about.count, 0);
    EXPECT_TRUE(outside.nodes().find({0.5f, 0.1f, 0.2f}, {{-1, 0, 0}, 0, true}, about));
    EXPECT_EQ(about.count, 0);
    EXPECT_FALSE(outside.nodes().find({3, 3, 3}, {{1, 0, 0}, 0, false}, about));
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
        // Entries belong to the inner sides alone, which are half of the nodes.
        const double factor =
            static_cast<double>(table.entries()) / (0.5 * static_cast<double>(table.size()) * directions);
        EXPECT_NEAR(factor / 0.1998, 1, directions == 16 ? 0.06 : 0.04) << directions;
    }
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
