#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/visibility/place_sequence.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A sensor for which a lit white plate has three hundred electrons: even an edge of full contrast, 50 of them
// a pass of 2 x 2 rays, is within 0.7 of its noise after fifteen passes or so.
PixelNoise sensor() {
    PixelNoise noise;
    noise.electrons_per_radiance[0] = 0.6f, noise.electrons_per_radiance[1] = 0.4f;
    noise.dark_variance_e2 = 100;
    noise.gain_fraction = 0.01f;
    return noise;
}

// Two white plates that light each other, edges and shadows in the picture: random paths matter everywhere.
class BudgetStage : public Stage {
  public:
    BudgetStage() {
        quality.max_depth = 3;
        quality.rays_across = 0;
        add(plate(lambert(0.9), grid), {-0.3, 0, 4}, {kPi, 0.5, 0});
        add(plate(lambert(0.9), grid), {0.9, 0.2, 4}, {kPi, -0.9, 0.3});
        sun({0.3, 0.2, -1});
    }
    // Electrons of every pixel, of a frame of its own random numbers.
    std::vector<float> electrons(std::uint64_t number) {
        renderer->set_pixel_noise(sensor());
        renderer->render(world, {1, number}, radiance, points, stats);
        std::vector<float> out;
        for (int y = 0; y < radiance.height(); ++y)
            for (std::size_t x = 0; x < static_cast<std::size_t>(radiance.width()); ++x) {
                Spectrum here;
                for (int b = 0; b < 2; ++b) here[b] = radiance.row(y, b)[x];
                out.push_back(sensor().electrons(here, 2));
            }
        return out;
    }
};

std::vector<float> converged() {
    BudgetStage s;
    s.quality.samples_per_axis = 8;
    s.quality.noise_budget = 1e-6;
    s.quality.max_passes = 63;
    s.build();
    return s.electrons(1000);
}

// Errors over the sensor's noise, in units of the budget.
struct Errors {
    double mean_square = 0;
    int count = 0;
};
Errors errors_of(BudgetStage& s, const std::vector<float>& truth, double budget, int frames) {
    Errors out;
    for (int frame = 0; frame < frames; ++frame) {
        const std::vector<float> e = s.electrons(static_cast<std::uint64_t>(frame));
        for (std::size_t i = 0; i < e.size(); ++i) {
            if (truth[i] <= 0) continue;
            const double unit_e = budget * std::sqrt(static_cast<double>(sensor().variance_e2(truth[i])));
            const double error = static_cast<double>(e[i] - truth[i]) / unit_e;
            out.mean_square += error * error;
            ++out.count;
        }
    }
    out.mean_square /= out.count;
    return out;
}

// Every run of 2^k places from a multiple of 2^k on has one in each box of 2^-a by 2^(a-k).
TEST(PlaceSequence, FillsEveryBoxOnce) {
    for (const std::uint32_t first : {0u, 64u, 960u})
        for (int k = 0; k <= 6; ++k)
            for (int a = 0; a <= k; ++a) {
                std::vector<int> boxes(std::size_t{1} << k);
                for (std::uint32_t i = 0; i < 1u << k; ++i) {
                    const auto [x, y] = place_in_sequence(first + i, 0x9E3779B9u, 0xBB67AE85u);
                    const int column = static_cast<int>(std::ldexp(x, a));
                    const int row = static_cast<int>(std::ldexp(y, k - a));
                    ++boxes.at(static_cast<std::size_t>((column << (k - a)) + row));
                }
                EXPECT_EQ(std::count(boxes.begin(), boxes.end(), 1), 1 << k) << first << " " << k << " " << a;
            }
}

TEST(NoiseBudget, TheErrorAgainstAConvergedPictureIsWithinIt) {
    const std::vector<float> truth = converged();
    for (const double budget : {1.0, 0.7}) {
        BudgetStage s;
        s.quality.samples_per_axis = 2;
        s.quality.noise_budget = budget;
        s.quality.max_passes = 63;
        s.build();
        const Errors within = errors_of(s, truth, budget, 4);
        ASSERT_GT(s.stats.lit_px, 300u);
        EXPECT_EQ(s.stats.within_budget_px, s.stats.lit_px) << budget;
        // A pixel that is within has a standard error of 1 unit or less, so its square is 1 or less on the
        // mean. Of n squares of normal numbers the mean scatters by sqrt(2 / n); five times that. The truth's
        // own error, of 63 passes of 8 x 8 rays, is some hundredths of a unit.
        const double most = 1 + 5 * std::sqrt(2.0 / within.count);
        EXPECT_LT(within.mean_square, most) << budget;

        // It is no waste either: what is sampled until it fits ends between half a unit and one.
        EXPECT_GT(within.mean_square, 0.1) << budget;

        // The same without a budget for more: most of the light is not within it.
        s.quality.max_passes = 1;
        s.build();
        EXPECT_GT(errors_of(s, truth, budget, 4).mean_square, most) << budget;
        EXPECT_LT(s.stats.within_budget_px, s.stats.lit_px);
    }
}

TEST(NoiseBudget, HalfTheBudgetCostsMoreAndAWeakSignalNothing) {
    const auto rays = [](double budget, float electrons_scale) {
        BudgetStage s;
        s.quality.noise_budget = budget;
        s.quality.max_passes = 63;
        s.build();
        PixelNoise noise = sensor();
        noise.electrons_per_radiance = electrons_scale * noise.electrons_per_radiance;
        s.renderer->set_pixel_noise(noise);
        s.render_again();
        return static_cast<double>(s.stats.primary_rays);
    };
    EXPECT_GT(rays(0.5, 1), 1.5 * rays(1, 1));
    // A signal far below the dark noise needs no second pass: as many rays as with one.
    BudgetStage once;
    once.render();
    EXPECT_EQ(rays(0.5, 0.01f), static_cast<double>(once.stats.primary_rays));
}

TEST(NoiseBudget, EmptySkyAndEvenLightCostNothing) {
    Stage s;
    s.quality.noise_budget = 0.01;
    s.quality.rays_across = 0;
    s.add(plate(lambert(0.5), s.grid), {0, 0, -3});  // behind the camera
    s.build();
    s.renderer->set_pixel_noise(sensor());
    s.render_again();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    EXPECT_EQ(s.stats.lit_px, 0u);
    // A plate that fills the picture is as bright everywhere: one pass.
    s.world.objects[0].position_world_m = {0, 0, 0.5};
    s.render_again();
    EXPECT_EQ(s.stats.primary_rays, 40u * 40u);
    EXPECT_EQ(s.stats.lit_px, 40u * 40u);
    EXPECT_EQ(s.stats.within_budget_px, s.stats.lit_px);
    // In the sky beside a small plate nothing is traced but the mask's blocks, four pixels about it.
    s.world.objects[0].position_world_m = {0, 0, 8};  // 8 px across
    s.render_again();
    EXPECT_GT(s.stats.lit_px, 8u * 8u - 1);
    EXPECT_LE(s.stats.primary_rays, 16u * 16u * 16u);
}

// A bright strip of a tenth of a pixel: two samples of a pixel miss it in 81 of 100 cases, and agree.
TEST(NoiseBudget, SamplesThatAgreeByChanceAreNotTrusted) {
    Stage s;
    s.quality.rays_across = 0;
    s.quality.max_depth = 1;
    s.quality.noise_budget = 0.3;
    s.quality.max_passes = 63;
    SceneObject strip = plate(lambert(1), s.grid);
    for (Vec3f& v : strip.mesh.vertices_m) v.y *= 0.005f;
    s.add(std::move(strip), {0, 0.01, 3.2});  // 20 px long, 0.1 px wide, inside a row of pixels
    s.build();
    s.renderer->set_pixel_noise(sensor());
    double sum = 0;
    constexpr int kFrames = 50;
    for (int frame = 0; frame < kFrames; ++frame) {
        s.renderer->render(s.world, {1, static_cast<std::uint64_t>(frame)}, s.radiance, s.points, s.stats);
        for (const float v : s.radiance.plane(0)) sum += static_cast<double>(v);
    }
    const double full = kSun_w_m2_um / kPi * 20 * 0.1;
    // Who stops where two samples agree keeps a fifth of the light: 0.22 +- 0.11 a frame, by a simulation of
    // the strip's pixels alone. With the neighbours a hit wakes those beside it, and they theirs in turn:
    // 0.68 +- 0.34. The mean of 50 frames is within four of its standard deviations of that.
    EXPECT_NEAR(sum / kFrames / full, 0.68, 4 * 0.34 / std::sqrt(kFrames));
}

TEST(NoiseBudget, DoesNotDependOnTheThreadCount) {
    const auto picture = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        BudgetStage s;
        s.quality.noise_budget = 0.3;
        s.build();
        std::vector<float> out = s.electrons(1);
        out.push_back(static_cast<float>(s.stats.within_budget_px));
        return out;
    };
    EXPECT_EQ(picture(1), picture(2));
}

TEST(NoiseBudget, OffItChangesNoBit) {
    const auto picture = [](std::int64_t passes, bool told) {
        BudgetStage s;
        s.quality.samples_per_axis = 2;
        s.quality.max_passes = passes;
        s.build();
        if (told) s.renderer->set_pixel_noise(sensor());
        s.render_again();
        return std::vector<float>(s.radiance.all().begin(), s.radiance.all().end());
    };
    EXPECT_EQ(picture(1, false), picture(63, true));
}

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
        level([](RenderQuality& q) { q.noise_budget = 0.5; }),
        level([](RenderQuality& q) { q.path_model = "cached", q.max_depth = 2; }),
        level([](RenderQuality& q) { q.path_model = "direct", q.samples_per_axis = 3; }),
        level([](RenderQuality& q) { q.contribution_threshold = 0.5; })};
    const auto prepare = [](BudgetStage& s, const RenderQuality& own, std::span<const RenderQuality> lower) {
        // A sphere of few pixels, which is drawn as points.
        s.add(sphere(8, lambert(0.5), s.grid), {-20, 20, 60});
        s.renderer =
            std::make_unique<Renderer>(copy_of(s.scene), s.grid, s.geometry, own, s.models, Modules(), lower);
        s.points.reserve(s.renderer->max_points());
    };
    BudgetStage all;
    prepare(all, levels.front(), std::span(levels).subspan(1));
    for (const std::size_t i : {4u, 0u, 3u, 1u, 2u, 0u, 1u}) {
        BudgetStage alone;
        prepare(alone, levels[i], {});
        all.renderer->use_level(i);
        EXPECT_EQ(all.electrons(1), alone.electrons(1)) << i;
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
