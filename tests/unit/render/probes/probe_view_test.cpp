#include "render/probes/probe_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

bool is_in(float a, float least, float most) { return a > least && a < most; }

// Two parallel squares a side apart, facing each other. Where a probe's ray leaves the lower one, geometry says whether it meets the
// upper one, and where; the edge may go either way, as points stand a little above their surface.
TEST(ProbeView, RaysMeetWhatStandsInTheirWay) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject plates =
        object_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                  {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}}, lambert(0.5), grid);
    const TransferTable table(plates.mesh, std::vector<std::uint8_t>(1), {60, 3000, false});
    constexpr float kEdge_m = 0.01f;
    std::size_t met = 0, free = 0;
    for (std::size_t n = 0; n < table.size(); ++n) {
        const SurfaceProbe& probe = table.probes().probes()[n];
        if (probe.point_m[0].z > 0.5f || unpack_normal(probe.mean_normal).z < 0) continue;
        const std::vector<ProbeRay> rays = rays_of(table, n);
        ASSERT_EQ(rays.size(), 60u);
        for (const ProbeRay& ray : rays) {
            EXPECT_NEAR(length(ray.dir), 1, 1e-4f);
            const Vec3f from = probe.point_m[ray.point];
            const Vec3f at = from + (1 - from.z) / ray.dir.z * ray.dir;
            if (is_in(at.x, kEdge_m, 1 - kEdge_m) && is_in(at.y, kEdge_m, 1 - kEdge_m)) {
                ASSERT_EQ(ray.meets, ProbeMeets::kProbe) << n;
                const Vec3f point = table.probes().probes()[ray.probe].point_m[0];
                EXPECT_LT(length(point - at), 2.5f * table.probes().cube_m()) << n;
                ++met;
            } else if (!is_in(at.x, -kEdge_m, 1 + kEdge_m) || !is_in(at.y, -kEdge_m, 1 + kEdge_m)) {
                ASSERT_EQ(ray.meets, ProbeMeets::kNothing) << n;
                ++free;
            }
        }
    }
    EXPECT_GT(met, 5000u);
    EXPECT_GT(free, 5000u);
}

// The outside of a box sees nothing of itself, and at the box's edges points of one face lie beside those of the next.
TEST(ProbeView, ABoxSeesNothingOfItself) {
    const SpectralGrid grid{{0.5, 0.6}};
    const SceneObject box = cube(lambert(0.5), grid);
    const TransferTable table(box.mesh, std::vector<std::uint8_t>(1), {60, 2000, false});
    ASSERT_GT(table.size(), 500u);
    for (std::size_t n = 0; n < table.size(); ++n) {
        int counted = 0;
        for (const ProbeRay& ray : rays_of(table, n)) {
            EXPECT_NE(ray.meets, ProbeMeets::kProbe) << n;
            counted += ray.meets != ProbeMeets::kBuried && ray.meets != ProbeMeets::kOwnSide;
        }
        EXPECT_EQ(counted, table.counted(n)) << n;
    }
}

}  // namespace
}  // namespace hilcam
