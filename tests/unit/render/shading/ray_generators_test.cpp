// Pictures by lenses that bend lines and by rows of their own instants.

#include <gtest/gtest.h>

#include <cstddef>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

TEST(Renderer, TheLensBendsWhatItSeesAndTheMaskFollows) {
    Stage s;
    s.geometry.distortion.k1 = -0.3;
    // A small plate off the axis: its middle falls where Brown's formula says.
    SceneObject small = plate(lambert(1), s.grid);
    for (Vec3f& v : small.mesh.vertices_m) v = 0.1f * v;
    s.add(std::move(small), {1.2, 0, 3});
    s.quality.rays_across = 256;
    s.quality.max_depth = 1;
    s.render();
    const double x = 0.4, bent = x * (1 - 0.3 * x * x);
    EXPECT_NEAR(s.light().centroid_px.x, 16 + 32 * bent, 0.05);
    EXPECT_NEAR(s.light().centroid_px.y, 16, 0.02);
}

// Rows read one after another: a camera that turns draws an upright edge aslant.
TEST(Renderer, RollingRowsHaveAPoseOfTheirOwn) {
    Stage s;
    s.models.rays = {"rolling", 1e-3};
    s.quality.max_depth = 1;
    s.add(plate(lambert(1), s.grid), {0, 0, 3});
    // 0.5 rad/s about -y turns the boresight to -x: things move to the right by 32 px 0.5 mrad each row.
    s.world.camera_rate_rad_s = {0, -0.5, 0};
    s.render();
    const auto left_edge = [&](int row) {
        for (int x = 0; x < 40; ++x)
            if (s.radiance.row(row)[static_cast<std::size_t>(x)] > 0) return x;
        return -1;
    };
    s.models.rays.line_time_s = 0.02;
    s.render();
    // From row 12 to row 28: 16 rows of 20 ms, 0.16 rad, 5.1 px and a little more off the axis.
    EXPECT_NEAR(left_edge(28) - left_edge(12), 5.3, 1.1);
}

}  // namespace
}  // namespace hilcam
