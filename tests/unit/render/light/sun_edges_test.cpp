#include "render/light/sun_edges.h"

#include <gtest/gtest.h>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A small plate before a large one, the Sun over the camera's right shoulder, and out of the picture what throws a
// shadow on the large one. The small one's own shadow misses it.
class SunEdgesTest : public testing::Test {
  protected:
    Stage s;

    SunEdgesTest() {
        s.quality.visibility = "buffer";
        s.quality.max_depth = 1;
        s.camera(160, 0.3);
        s.sun({1, 0, -1});
        add(0.25f, {0, 0, 3.5});
        add(1, {0, 0, 5});
        add(1.2f, kAway);
        s.build();
    }
    static constexpr Vec3d kAway{3, 30, 2};

    std::uint64_t rays_with_it_at(Vec3d position_m) {
        s.world.objects.back().position_world_m = position_m;
        s.render_again();
        return s.stats.shadow_rays;
    }
    // Radiance at a place of the picture, as a share of that of a plate in the Sun.
    float lit(int x_px, int y_px) const {
        const auto at = [&](int x, int y) { return s.radiance.row(y)[static_cast<std::size_t>(x)]; };
        return at(x_px, y_px) / at(80, 80);
    }

  private:
    void add(float size, Vec3d position_m) {
        SceneObject object = plate(lambert(0.5), s.grid);
        for (Vec3f& v : object.mesh.vertices_m) v = size * v;
        s.add(std::move(object), position_m);
    }
};

// Where a plate in the Sun hides one that lies in shadow, no edge of a shadow falls on either.
TEST_F(SunEdgesTest, AnOutlineBeforeWhatIsDarkIsNone) {
    const std::uint64_t all_lit = rays_with_it_at(kAway);
    EXPECT_NEAR(lit(40, 80), 1, 1e-5);
    EXPECT_EQ(rays_with_it_at({3, 0, 2}), all_lit);
    EXPECT_EQ(lit(40, 80), 0);
}

// The large plate is 107 pixels high, and the edge runs down it beside the small one: two pixels of each row send
// four rays more.
TEST_F(SunEdgesTest, VerticesOnBothSidesOfAShadowsEdgeAskAgain) {
    const std::uint64_t all_lit = rays_with_it_at(kAway);
    const std::uint64_t more = rays_with_it_at({3.6, 0, 2}) - all_lit;
    EXPECT_NEAR(lit(30, 80), 1, 1e-5);
    EXPECT_EQ(lit(130, 80), 0);
    EXPECT_GE(more, 107u * 2 * 4);
    EXPECT_LE(more, 109u * 2 * 4);
}

}  // namespace
}  // namespace hilcam
