// With the Sun's disk, rays go through places by chance all over their pixels (RenderQuality::scatters_rays).

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A plate of 20 x 20 pixels whose right edge leaves three tenths of column 30 to it.
class PlateStage : public Stage {
  public:
    explicit PlateStage(bool sun_disk) {
        quality.sun_disk = sun_disk;
        quality.samples_per_axis = 2;
        quality.path_model = "direct";
        quality.rays_across = 0;
        add(plate(lambert(1), grid), {0.03, 0, 3.2});
        build();
        points.reserve(renderer->max_points());
    }
    void render_frame(std::uint64_t number) { renderer->render(world, {1, number}, radiance, points, stats); }
};

constexpr int kFirstRow = 11, kRows = 18;  // rows that the plate fills

// The mean share of column 30 that is lit, over rows and frames.
double share_lit(PlateStage& s, int frames) {
    double sum = 0;
    for (int frame = 0; frame < frames; ++frame) {
        s.render_frame(static_cast<std::uint64_t>(frame));
        for (int y = kFirstRow; y < kFirstRow + kRows; ++y)
            sum += static_cast<double>(s.radiance.row(y)[30]) / static_cast<double>(s.radiance.row(y)[20]);
    }
    return sum / (frames * kRows);
}

TEST(ScatteredRays, FramesThatAreAveragedHaveNoGridInCommon) {
    // Columns of the grid are at a quarter and at three quarters: one of two is lit, however many frames there are.
    PlateStage grid(false);
    EXPECT_NEAR(share_lit(grid, 2), 0.5, 1e-4);
    // Four places of the sequence have one in each quarter of the width. That in the first quarter is lit, that in the second with a chance
    // of a fifth: a share's variance is 0.2 0.8 / 16, so that of the mean of 25 frames of 18 rows has the standard deviation 0.1 / sqrt(450).
    // Five times that.
    PlateStage scattered(true);
    EXPECT_NEAR(share_lit(scattered, 25), 0.3, 5 * 0.1 / std::sqrt(450));
}

TEST(ScatteredRays, DoNotDependOnTheThreadCount) {
    const auto picture = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        PlateStage s(true);
        s.render_frame(1);
        return std::vector<float>(s.radiance.all().begin(), s.radiance.all().end());
    };
    EXPECT_EQ(picture(1), picture(2));
}

}  // namespace
}  // namespace hilcam
