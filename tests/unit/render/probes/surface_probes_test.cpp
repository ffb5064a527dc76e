#include "render/probes/surface_probes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Nothing stands near a point.
const Openness kFree = [](Vec3f, Vec3f, float, float) { return OpenShares{1, 1}; };
// Nothing stands between any two points.
const Sight kOpen = [](Vec3f, Vec3f) { return std::nullopt; };

// Two floors of one surface, one half a cube above the other: places on each have probes on that floor alone.
TEST(SurfaceProbes, WallsBehindEachOtherAreApart) {
    const SpectralGrid grid{{0.5, 0.6}};
    const auto probes_of = [&](float above_m) {
        const float z = above_m;
        const SceneObject floors = object_of(
            {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}},
            {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, lambert(0.5), grid);
        return SurfaceProbes(floors.mesh, std::vector<std::uint8_t>(1, 1), 3000, kFree, kOpen);
    };
    const float above_m = 0.5f * probes_of(0.01f).cube_m();
    const SurfaceProbes probes = probes_of(above_m);
    for (const float z : {0.0f, above_m})
        for (const float x : {0.21f, 0.5f, 0.83f}) {
            ProbeWeights about;
            ASSERT_TRUE(probes.find({x, 0.4f, z}, {{0, 0, 1}, 0, false}, about));
            EXPECT_GT(about.count, 0u);
            for (std::size_t i = 0; i < about.count; ++i)
                for (const Vec3f point : probes.probes()[about.probe[i]].point_m)
                    EXPECT_NEAR(point.z, z, 0.1f * above_m) << x;
        }
    EXPECT_TRUE(probes.is_whole());
}

// Two walls that stand on one edge: each probe has others beside it, they have it, and all of them lie near on its own wall.
TEST(SurfaceProbes, HaveThoseBesideThemOnTheirWall) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject walls =
        object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}},
                  {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, lambert(0.5), grid);
    const SurfaceProbes probes(walls.mesh, std::vector<std::uint8_t>(1, 1), 3000, kFree, kOpen);
    const ProbeNeighbours neighbours = probes.neighbours();
    ASSERT_EQ(neighbours.first.size(), probes.probes().size() + 1);
    for (std::uint32_t n = 0; n < probes.probes().size(); ++n) {
        const SurfaceProbe& probe = probes.probes()[n];
        const std::span<const std::uint32_t> beside = neighbours.of(n);
        EXPECT_FALSE(beside.empty()) << n;
        for (const std::uint32_t other : beside) {
            EXPECT_NE(other, n);
            const std::span<const std::uint32_t> back = neighbours.of(other);
            EXPECT_TRUE(std::binary_search(back.begin(), back.end(), n));
            EXPECT_EQ(probes.probes()[other].mean_normal, probe.mean_normal);
            EXPECT_LT(length(probes.probes()[other].point_m[0] - probe.point_m[0]), 4 * probes.cube_m());
        }
    }
}

// A wall across a floor: a place has the light of probes on its own side, however near to the wall it is, and no probe lies
// beside one of the other side.
TEST(SurfaceProbes, AWallDividesThem) {
    constexpr float kWall_m = 0.437f;
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject floor =
        object_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, lambert(0.5), grid);
    const auto probes_of = [&](const Sight& sight) {
        return SurfaceProbes(floor.mesh, std::vector<std::uint8_t>(1, 1), 3000, kFree, sight);
    };
    // Returns how many points of probes about places of this side lie on the other.
    const auto beyond = [&](const SurfaceProbes& probes, float x_m) {
        int count = 0;
        for (const float y_m : {0.21f, 0.5f, 0.83f}) {
            ProbeWeights about;
            EXPECT_TRUE(probes.find({x_m, y_m, 0}, {{0, 0, 1}, 0, false}, about));
            float sum = 0;
            for (std::size_t i = 0; i < about.count; ++i) {
                sum += about.weight[i];
                for (const Vec3f point : probes.probes()[about.probe[i]].point_m)
                    count += about.weight[i] > 0 && (point.x > kWall_m) != (x_m > kWall_m);
            }
            EXPECT_NEAR(sum, 1, 1e-5f);
        }
        return count;
    };
    const SurfaceProbes open = probes_of(kOpen);
    const SurfaceProbes divided = probes_of([&](Vec3f from_m, Vec3f to_m) -> std::optional<Wall> {
        if ((from_m.x > kWall_m) == (to_m.x > kWall_m)) return std::nullopt;
        const float t = (kWall_m - from_m.x) / (to_m.x - from_m.x);
        return Wall{from_m + t * (to_m - from_m), {-1, 0, 0}};
    });
    for (const float off_m : {-0.3f, -0.01f, 0.01f, 0.3f}) {
        EXPECT_EQ(beyond(divided, kWall_m + off_m), 0) << off_m;
    }
    EXPECT_GT(beyond(open, kWall_m - 0.01f), 0);
    EXPECT_TRUE(divided.is_whole());
    const ProbeNeighbours neighbours = divided.neighbours();
    for (std::uint32_t n = 0; n < divided.probes().size(); ++n) {
        EXPECT_FALSE(neighbours.of(n).empty());
        for (const std::uint32_t other : neighbours.of(n))
            EXPECT_EQ(divided.probes()[n].point_m[0].x > kWall_m,
                      divided.probes()[other].point_m[0].x > kWall_m);
    }

    // Where one side goes, its places have no light, and the other side has what it had.
    SurfaceProbes left = divided;
    std::vector<std::uint32_t> numbers(left.probes().size(), SurfaceProbes::kClosed);
    std::uint32_t kept = 0;
    for (std::size_t n = 0; n < numbers.size(); ++n)
        if (left.probes()[n].point_m[0].x < kWall_m) numbers[n] = kept++;
    left.keep(numbers);
    EXPECT_TRUE(left.is_whole());
    EXPECT_EQ(beyond(left, kWall_m - 0.01f), 0);
    ProbeWeights about;
    EXPECT_TRUE(left.find({kWall_m + 0.01f, 0.5f, 0}, {{0, 0, 1}, 0, false}, about));
    EXPECT_EQ(about.count, 0u);
}

// A strip of the floor is a nook: no point of a probe lies there, but where a floor has nothing else.
TEST(SurfaceProbes, PointsAvoidNooks) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject floor =
        object_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, lambert(0.5), grid);
    const auto points_within = [&](float nook_m) {
        // Something is next to points of the strip; a little further off, there is not more than elsewhere.
        const SurfaceProbes probes(
            floor.mesh, std::vector<std::uint8_t>(1, 1), 300,
            [&](Vec3f at_m, Vec3f, float, float) {
                return OpenShares{at_m.x < nook_m ? 0.5f : 1.0f, 0.5f};
            },
            kOpen);
        std::size_t count = 0, all = 0;
        for (const SurfaceProbe& probe : probes.probes())
            for (const Vec3f point : probe.point_m) count += point.x < nook_m, ++all;
        return static_cast<double>(count) / static_cast<double>(all);
    };
    EXPECT_EQ(points_within(0.02f), 0);
    EXPECT_EQ(points_within(2), 1);
}

}  // namespace
}  // namespace hilcam
