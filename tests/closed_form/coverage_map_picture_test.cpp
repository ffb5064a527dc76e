// A panel with gaps thinner than a pixel, as the visibility buffer sees it by its coverage map (render/lod/coverage_map.h),
// against the areas of tiles in each pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/lod/mesh_lod.h"
#include "tests/support/stage.h"
#include "tests/support/tiled_panel.h"

namespace hilcam {
namespace {

constexpr double kGround = 0.8, kTile = 0.05, kDistance_m = 100;
constexpr int kSize_px = 64;

// A panel of 2 m that fills the picture but for its border, seen from straight above.
class Panel {
  public:
    Stage s;
    TiledPanel panel;
    double pixel_m;

    Panel(double pixel_m_in, bool coverage_map, Vec3f sun) : pixel_m(pixel_m_in) {
        s.quality.path_model = "direct";
        s.quality.visibility = "buffer";
        s.quality.rays_across = 0;
        s.quality.lod_error_px = 1;
        s.camera(kSize_px, 0.5 * kSize_px * pixel_m / kDistance_m);
        s.sun(to_double(sun));
        SceneObject object;
        object.mesh = panel.mesh();
        for (Vec3f& at : object.mesh.vertices_m) at = at - Vec3f{1, 1, 0};
        object.materials = {make_material(lambert(kGround), s.grid), make_material(lambert(kTile), s.grid)};
        if (coverage_map) object.levels = {MeshLevel{object.mesh, kError_m, {0, 0}, {}}};
        s.add(std::move(object), {0, 0, static_cast<float>(kDistance_m)});
        s.render();
    }
    // Over the picture without its border: how far pixels are off, as a mean and as a root mean square, of white paint's light.
    struct Error {
        double mean, rms;
    };
    // lit: of the ground that is seen.
    Error error(double cosine, double lit) const {
        double sum = 0, squares = 0;
        int count = 0;
        const double corner_m = panel.side_m() / 2 - 0.5 * kSize_px * pixel_m;
        for (int y = 4; y < kSize_px - 4; ++y)
            for (int x = 4; x < kSize_px - 4; ++x) {
                const double left_m = corner_m + x * pixel_m, top_m = corner_m + y * pixel_m;
                const double tiles =
                    panel.covered(left_m, left_m + pixel_m) * panel.covered(top_m, top_m + pixel_m);
                const double truth = cosine * (kTile * tiles + kGround * lit * (1 - tiles));
                const double seen = static_cast<double>(s.radiance.row(y)[static_cast<std::size_t>(x)]) *
                                    kPi / static_cast<double>(kSun_w_m2_um);
                sum += seen - truth, squares += (seen - truth) * (seen - truth);
                ++count;
            }
        return {sum / count, std::sqrt(squares / count)};
    }

  private:
    static constexpr double kError_m = 0.004;
};

TEST(CoverageMapPicture, PixelsHaveTheAreasOfGapsAndTiles) {
    for (const double pixel_m : {0.0191, 0.0283}) {
        const Panel::Error coverage_map = Panel(pixel_m, true, {0, 0, -1}).error(1, 1),
                           samples = Panel(pixel_m, false, {0, 0, -1}).error(1, 1);
        EXPECT_NEAR(coverage_map.mean, 0, 5e-4) << pixel_m;
        // A texel is 0.28 of the larger pixel, over which its sides fall off.
        EXPECT_LT(coverage_map.rms, 0.025) << pixel_m;
        // What sixteen samples meet of them has a moire.
        EXPECT_GT(samples.rms, 3 * coverage_map.rms) << pixel_m;
    }
}

// The Sun 45 degrees aside, along the rows: gaps across its way are lit but for a fifth, the others wholly.
TEST(CoverageMapPicture, TilesShadeTheGapsBesideThem) {
    const double cosine = std::sqrt(0.5);
    const Panel seen(0.0283, true, {1, 0, -1});
    const double gap = seen.panel.gap_m / seen.panel.pitch_m;
    const double aside = gap * (1 - gap), along = gap;
    const double lit = 1 - 0.2 * aside / (aside + along);
    EXPECT_NEAR(seen.error(cosine, lit).mean, 0, 5e-4);
    EXPECT_GT(std::abs(seen.error(cosine, 1).mean), 2e-3);
}

// Tiles and gaps of a pixel ask for the Sun by one ray, though each is lit by itself.
TEST(CoverageMapPicture, OneRayToTheSunTellsForAPixelsLayers) {
    const Panel seen(0.0283, true, {0, 0, -1});
    const double covered_px = seen.s.stats.coverage * kSize_px * kSize_px;
    EXPECT_GT(covered_px, 0.9 * kSize_px * kSize_px);
    EXPECT_LE(static_cast<double>(seen.s.stats.shadow_rays), covered_px);
}

// From behind the panel is its ground, and from its edge nothing.
TEST(CoverageMapPicture, IsTheGroundFromBehind) {
    Stage s;
    s.quality.path_model = "direct", s.quality.visibility = "buffer", s.quality.rays_across = 0,
    s.quality.lod_error_px = 1;
    s.camera(32, 0.5 * 32 * 0.03 / kDistance_m);
    s.sun({0, 0, -1});
    SceneObject object;
    object.mesh = TiledPanel{}.mesh();
    for (Vec3f& at : object.mesh.vertices_m) at = at - Vec3f{1, 1, 0};
    object.materials = {make_material(lambert(kGround), s.grid), make_material(lambert(kTile), s.grid)};
    object.levels = {MeshLevel{object.mesh, 0.004, {0, 0}, {}}};
    s.add(std::move(object), {0, 0, static_cast<float>(kDistance_m)}, {0, 0, 0});
    s.render();
    EXPECT_NEAR(static_cast<double>(s.radiance.row(16)[16]) * kPi / static_cast<double>(kSun_w_m2_um),
                kGround, 1e-3);
    for (const float turn : {0.5f, 1.5f}) {
        s.world.objects[0].world_from_body = from_rotation_vector({turn * static_cast<float>(kPi), 0, 0});
        s.render_again();
        for (const float value : s.radiance.plane(0)) EXPECT_TRUE(std::isfinite(value));
    }
}

}  // namespace
}  // namespace hilcam
