#include <gtest/gtest.h>

#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Two white plates that light each other, edges and shadows in the picture: random paths matter everywhere.
class PlatesStage : public Stage {
  public:
    PlatesStage() {
        quality.max_depth = 3;
        quality.rays_across = 0;
        add(plate(lambert(0.9), grid), {-0.3, 0, 4}, {kPi, 0.5, 0});
        add(plate(lambert(0.9), grid), {0.9, 0.2, 4}, {kPi, -0.9, 0.3});
        sun({0.3, 0.2, -1});
    }
    std::vector<float> picture() {
        renderer->render(world, {1, 1}, radiance, points, stats);
        return {radiance.all().begin(), radiance.all().end()};
    }
};

// Quality levels in one renderer give the frames of renderers of their own, in any order.
TEST(QualityLevels, ALevelIsTheQualityThatItNames) {
    const auto level = [](auto change) {
        RenderQuality q;
        q.max_depth = 3;
        change(q);
        return q;
    };
    const std::vector<RenderQuality> levels = {
        level([](RenderQuality& q) { q.samples_per_axis = 2, q.sun_disk = true; }),
        level([](RenderQuality& q) { q.sun_disk = true; }),
        level([](RenderQuality& q) { q.path_model = "cached", q.max_depth = 2; }),
        level([](RenderQuality& q) { q.path_model = "direct", q.samples_per_axis = 3; }),
        level([](RenderQuality& q) { q.contribution_threshold = 0.5; })};
    const auto prepare = [](PlatesStage& s, const RenderQuality& own, std::span<const RenderQuality> lower) {
        // A sphere of few pixels, which is drawn as points.
        s.add(sphere(8, lambert(0.5), s.grid), {-20, 20, 60});
        s.renderer =
            std::make_unique<Renderer>(copy_of(s.scene), s.grid, s.geometry, own, s.models, Modules(), lower);
        s.points.reserve(s.renderer->max_points());
    };
    PlatesStage all;
    prepare(all, levels.front(), std::span(levels).subspan(1));
    for (const std::size_t i : {4u, 0u, 3u, 1u, 2u, 0u, 1u}) {
        PlatesStage alone;
        prepare(alone, levels[i], {});
        all.renderer->use_level(i);
        EXPECT_EQ(all.picture(), alone.picture()) << i;
        // What is marked as dark is dark, whichever level has marked it.
        for (int y = 0; y < all.radiance.height(); ++y)
            for (int x = 0; x < all.radiance.width(); ++x)
                EXPECT_TRUE(!all.radiance.dark(x, y) || all.radiance.row(y)[static_cast<std::size_t>(x)] == 0)
                    << i;
        ASSERT_EQ(all.points.size(), alone.points.size());
        EXPECT_GT(all.points.size(), 0u);
        for (std::size_t k = 0; k < all.points.size(); ++k)
            EXPECT_EQ(all.points[k].irradiance_w_m2_um[0], alone.points[k].irradiance_w_m2_um[0]) << i;
    }
}

}  // namespace
}  // namespace hilcam
