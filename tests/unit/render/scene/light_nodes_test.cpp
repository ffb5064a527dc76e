#include "render/scene/light_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Nothing stands between any two points.
const Sight kOpen = [](Vec3f, Vec3f) { return std::nullopt; };

// Two floors of one surface, one half a cube above the other: places on each have nodes on that floor alone.
TEST(LightNodes, WallsBehindEachOtherAreApart) {
    const SpectralGrid grid{{0.5, 0.6}};
    const auto nodes_of = [&](float above_m) {
        const float z = above_m;
        const SceneObject floors = object_of(
            {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}},
            {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, lambert(0.5), grid);
        return LightNodes(
            floors.mesh, std::vector<std::uint8_t>(1, 1), 3000, [](Vec3f, Vec3f, float) { return 1.0f; },
            kOpen);
    };
    const float above_m = 0.5f * nodes_of(0.01f).cube_m();
    const LightNodes nodes = nodes_of(above_m);
    for (const float z : {0.0f, above_m})
        for (const float x : {0.21f, 0.5f, 0.83f}) {
            NodesAbout about;
            ASSERT_TRUE(nodes.find({x, 0.4f, z}, {{0, 0, 1}, 0, false}, about));
            EXPECT_GT(about.count, 0u);
            for (std::size_t i = 0; i < about.count; ++i)
                for (const Vec3f point : nodes.nodes()[about.node[i]].point_m)
                    EXPECT_NEAR(point.z, z, 0.1f * above_m) << x;
        }
    EXPECT_TRUE(nodes.is_whole());
}

// Two walls that stand on one edge: each node has others beside it, they have it, and all of them lie near on its own wall.
TEST(LightNodes, HaveThoseBesideThemOnTheirWall) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject walls =
        object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}},
                  {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, lambert(0.5), grid);
    const LightNodes nodes(
        walls.mesh, std::vector<std::uint8_t>(1, 1), 3000, [](Vec3f, Vec3f, float) { return 1.0f; }, kOpen);
    const NodeNeighbours neighbours = nodes.neighbours();
    ASSERT_EQ(neighbours.first.size(), nodes.nodes().size() + 1);
    for (std::uint32_t n = 0; n < nodes.nodes().size(); ++n) {
        const LightNode& node = nodes.nodes()[n];
        const std::span<const std::uint32_t> beside = neighbours.of(n);
        EXPECT_FALSE(beside.empty()) << n;
        for (const std::uint32_t other : beside) {
            EXPECT_NE(other, n);
            const std::span<const std::uint32_t> back = neighbours.of(other);
            EXPECT_TRUE(std::binary_search(back.begin(), back.end(), n));
            EXPECT_EQ(nodes.nodes()[other].mean_normal, node.mean_normal);
            EXPECT_LT(length(nodes.nodes()[other].point_m[0] - node.point_m[0]), 4 * nodes.cube_m());
        }
    }
}

}  // namespace
}  // namespace hilcam
