// Frames of a path model at fault.

#include "render/frame/finite_light.h"

#include <gmock/gmock.h>

#include <limits>

#include "render/paths/modules.h"
#include "render/paths/path_models.h"
#include "render/shading/tile.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Every third pixel's light is no number.
class Faulty final : public PathModel {
  public:
    void trace(Tile& tile) override {
        const int width = tile.box.x1 - tile.box.x0;
        for (std::size_t i = 0; i < tile.pixels.size(); ++i)
            tile.pixels[i][0] += is_faulty(tile.box.x0 + static_cast<int>(i) % width)
                                     ? std::numeric_limits<float>::quiet_NaN()
                                     : static_cast<float>(tile.samples_per_axis * tile.samples_per_axis);
    }
    static bool is_faulty(int x) { return x % 3 == 0; }
};

TEST(FiniteLight, WhatIsNoNumberIsLeftOutAndTold) {
    Modules modules;
    modules.paths.add("faulty", [] { return std::make_unique<Faulty>(); });
    for (const bool scattered : {false, true}) {
        Stage s;
        s.quality.path_model = "faulty";
        s.quality.visibility = "rays";
        s.quality.sun_disk = scattered;
        s.add(plate(lambert(0.5), s.grid), {0, 0, 1});  // wherever the camera looks
        Renderer renderer(copy_of(s.scene), s.grid, s.geometry, s.quality, s.models, modules);
        s.points.reserve(renderer.max_points());
        EXPECT_EQ(renderer.fault(), "");
        renderer.render(s.world, {1, 1}, s.radiance, s.points, s.stats);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_EQ(s.radiance.row(y)[static_cast<std::size_t>(x)], Faulty::is_faulty(x) ? 0 : 1);
        EXPECT_EQ(s.stats.not_finite, 40u * 14);
        EXPECT_THAT(renderer.fault(), testing::HasSubstr("no number"));
    }
}

}  // namespace
}  // namespace hilcam
