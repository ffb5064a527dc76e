// What a frame traces, and what it does not.

#include <gtest/gtest.h>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A block beside a plate, both in the Sun: the camera's own sight of them, and what paths find of the block.
TEST(Renderer, RaysAreCountedByWhatTheyAreFor) {
    Stage s;
    s.sun({1, 0, -1});
    s.add(plate(lambert(0.5), s.grid), {0, 0, 3});
    s.add(cube(lambert(0.5), s.grid), {-1, 0, 2.4});
    s.quality.max_depth = 1;
    s.quality.contribution_threshold = 0;
    s.render();
    const RayCounts direct = s.stats;
    EXPECT_GT(direct.shadow_rays, 0u);
    EXPECT_LE(direct.shadow_rays, direct.primary_rays);
    EXPECT_EQ(direct.bounce_shadow_rays + direct.secondary_rays + direct.lamp_rays, 0u);
    s.quality.max_depth = 2;
    s.render();
    EXPECT_EQ(s.stats.primary_rays, direct.primary_rays);
    EXPECT_EQ(s.stats.shadow_rays, direct.shadow_rays);
    EXPECT_GT(s.stats.bounce_shadow_rays, 0u);
    EXPECT_GT(s.stats.secondary_rays, s.stats.bounce_shadow_rays);  // a second surface has one Sun
    EXPECT_EQ(s.stats.lamp_rays, 0u);
}

// Models that a frame does not need cost it nothing: no ray, no look into the air, no point.
TEST(Renderer, NothingUnneededIsTraced) {
    Stage s;
    s.quality.max_depth = 1;
    s.render();  // an empty sky
    EXPECT_EQ(s.stats.primary_rays + s.stats.shadow_rays + s.stats.lamp_rays + s.stats.secondary_rays, 0u);
    s.add(plate(lambert(0.5), s.grid), {0, 0, -3});  // behind the camera
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, -300};  // there as points
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, 300};
    s.render();
    EXPECT_GT(s.stats.primary_rays, 0u);
    s.world.objects[0].position_world_m = {0, 0, 3};
    s.sun({0, 0, 1});  // on its back
    s.render();
    EXPECT_GT(s.stats.primary_rays, 0u);
    EXPECT_EQ(s.stats.shadow_rays, 0u);
    s.sun({0, 0, -1});
    s.render();
    const auto shadow_rays = s.stats.shadow_rays;
    EXPECT_GT(shadow_rays, 0u);
    EXPECT_EQ(s.stats.lamp_rays, 0u);       // no body
    EXPECT_EQ(s.stats.secondary_rays, 0u);  // no depth
    // The Earth out of the field adds its own light, and no primary ray.
    const auto primary_rays = s.stats.primary_rays;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {30e6, 0, -30e6};
    s.quality.contribution_threshold = 0;
    s.render();
    EXPECT_EQ(s.stats.primary_rays, primary_rays);
    EXPECT_EQ(s.stats.shadow_rays, shadow_rays);
    EXPECT_GT(s.stats.lamp_rays, 0u);
    // Below the threshold it is not asked.
    s.quality.contribution_threshold = 0.05;
    s.render();
    EXPECT_EQ(s.stats.lamp_rays + s.stats.secondary_rays + s.stats.bounce_shadow_rays, 0u);
    EXPECT_TRUE(s.points.empty());
}

}  // namespace
}  // namespace hilcam
