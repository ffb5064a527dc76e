#include "render/lod/coverage_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "render/lod/coverage_map_finder.h"
#include "render/scene/coplanar_groups.h"
#include "render/scene/surface.h"
#include "tests/support/tiled_panel.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

constexpr double kError_m = 0.004;

ObjectSurfaces surfaces_of(const Mesh& mesh) {
    return {mesh, std::vector<Material>(mesh.surfaces.size()),
            std::make_shared<const std::vector<MipTexture>>()};
}

// Leans against all axes, so that corners are rounded.
Mesh leaning(Mesh mesh) {
    const Mat3d turn = to_matrix(normalized(Quat{0.8, 0.3, -0.4, 0.2}));
    for (Vec3f& at : mesh.vertices_m) at = to_float(turn * to_double(at) + Vec3d{2, 3, 1});
    return mesh;
}

std::vector<CoverageMap> coverage_maps_of(const Mesh& mesh) {
    return find_coverage_maps(mesh, may_be_in_coverage_maps(mesh, surfaces_of(mesh)), kError_m);
}

// A pixel of so many metres whose sides are turned against the coverage map's.
CoverageMap::Footprint pixel_at(const CoverageMap& coverage_map, Vec2d middle_m, double size_m,
                                double turned_rad) {
    const double per_m = 1 / static_cast<double>(coverage_map.texel_m), step = per_m * size_m;
    const auto c = static_cast<float>(step * std::cos(turned_rad)),
               s = static_cast<float>(step * std::sin(turned_rad));
    return {{per_m * middle_m.x, per_m * middle_m.y}, {c, s}, {-s, c}};
}

TEST(CoverageMap, IsFoundWhereTilesLieOnTheGround) {
    const TiledPanel panel;
    const std::vector<CoverageMap> found = coverage_maps_of(leaning(panel.mesh()));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].layers, 2u);
    EXPECT_EQ(found[0].surface[0], 0);
    EXPECT_EQ(found[0].surface[1], 1);
    EXPECT_NEAR(found[0].width_m, panel.side_m(), 1e-5);
    EXPECT_NEAR(found[0].height_m, panel.side_m(), 1e-5);
    EXPECT_NEAR(found[0].above_m, panel.height_m, 1e-5);
    EXPECT_NEAR(found[0].texel_m, kError_m, 1e-9);
}

TEST(CoverageMap, IsNotFoundWhereTilesStandApartLeanOrHaveColours) {
    EXPECT_TRUE(coverage_maps_of(TiledPanel{.height_m = 2 * kError_m}.mesh()).empty());
    Mesh leans = TiledPanel{}.mesh();
    for (std::size_t i = 4; i < leans.vertices_m.size(); i += 4)
        leans.vertices_m[i].z += 0.001f, leans.vertices_m[i + 1].z += 0.001f;  // 0.6 degrees
    EXPECT_TRUE(coverage_maps_of(leans).empty());
    Mesh colored = TiledPanel{}.mesh();
    colored.colors.assign(colored.vertices_m.size(), {1, 0.5f, 0.5f});
    EXPECT_TRUE(coverage_maps_of(colored).empty());
    EXPECT_TRUE(coverage_maps_of(TiledPanel{.gap_m = 0}.mesh()).empty());  // of the ground nothing is seen
}

TEST(CoverageMap, HasTheAreasOfItsTriangles) {
    const TiledPanel panel;
    const CoverageMap coverage_map = coverage_maps_of(leaning(panel.mesh())).at(0);
    const double tiles = std::pow(1 - panel.gap_m / panel.pitch_m, 2);
    // Ten tiles each way, however the pixel lies.
    const CoverageMap::Coverage whole =
        coverage_map.coverage(pixel_at(coverage_map, {1, 1}, 10 * panel.pitch_m, 0), {});
    // Texels are a third of the pixel, over which its sides fall off.
    EXPECT_NEAR(whole.share[1], tiles, 5e-3);
    EXPECT_NEAR(whole.share[0] + whole.share[1], 1, 1e-6);
    EXPECT_NEAR(whole.place[0].x, 0.5, 0.02);
    // A pixel of a third of a tile has a gap or none.
    for (const double x_m : {1.0, 1.03, 1.05}) {
        const double half_m = 0.0165;
        const CoverageMap::Coverage small =
            coverage_map.coverage(pixel_at(coverage_map, {x_m, 1.05}, 2 * half_m, 0), {});
        EXPECT_NEAR(small.share[1], panel.covered(x_m - half_m, x_m + half_m), 0.02) << x_m;
    }
    // Nothing beside it.
    EXPECT_EQ(coverage_map.coverage(pixel_at(coverage_map, {-1, 1}, 0.1, 0), {}).share,
              (std::array<float, CoverageMap::kMaxLayers>{}));
}

// Whatever the phase of pixels and gaps is, none is lost: the mean is the areas', and no pixel has a gap that another has, too.
TEST(CoverageMap, PixelsSideBySideAddUpToIt) {
    const TiledPanel panel;
    const CoverageMap coverage_map = coverage_maps_of(leaning(panel.mesh())).at(0);
    for (const double size_m : {0.011, 0.031, 0.07})
        for (const double turned : {0.0, 0.3, 0.8}) {
            double sum = 0;
            int count = 0;
            const int half = static_cast<int>(0.5 / size_m);
            for (int j = -half; j <= half; ++j)
                for (int i = -half; i <= half; ++i) {
                    const double x = size_m * (i * std::cos(turned) - j * std::sin(turned)),
                                 y = size_m * (i * std::sin(turned) + j * std::cos(turned));
                    sum += static_cast<double>(
                        coverage_map.coverage(pixel_at(coverage_map, {1 + x, 1 + y}, size_m, turned), {})
                            .share[0]);
                    ++count;
                }
            const double side_m = size_m * (2 * half + 1);
            const double tiles = turned == 0 ? panel.covered(1 - 0.5 * side_m, 1 + 0.5 * side_m)
                                             : 1 - panel.gap_m / panel.pitch_m;
            EXPECT_NEAR(sum / count, 1 - tiles * tiles, 0.003) << size_m << ", " << turned;
        }
}

// Seen at a flat angle a pixel is long, and texels as many; nothing is lost nor out of bounds.
TEST(CoverageMap, IsSeenFromNearItsEdge) {
    const CoverageMap coverage_map = coverage_maps_of(leaning(TiledPanel{}.mesh())).at(0);
    for (const float longer : {3.0f, 30.0f, 3e3f, 1e6f}) {
        CoverageMap::Footprint pixel = pixel_at(coverage_map, {1.05, 1.05}, 0.02, 0.3);
        pixel.per_y = {longer * pixel.per_y.x, longer * pixel.per_y.y};
        const CoverageMap::Coverage look = coverage_map.coverage(pixel, {});
        EXPECT_NEAR(look.share[0] + look.share[1], 1, 1e-5) << longer;
        EXPECT_GT(look.share[1], 0.7f) << longer;
    }
    EXPECT_EQ(coverage_map.coverage({{1, 1}, {1, 1}, {1, 1}}, {}).share[1], 0);
}

// In a gap of five millimetres a millimetre below, the Sun 45 degrees to its side lights four fifths; along it, all.
TEST(CoverageMap, GapsAreShadedAsNarrowAsTheyAre) {
    const TiledPanel panel;
    const CoverageMap coverage_map = coverage_maps_of(panel.mesh()).at(0);
    const auto lit = [&](Vec2d at_m, Vec2f way) {
        const Vec3d from = Vec3d{at_m.x, at_m.y, panel.height_m} - to_double(coverage_map.corner_m);
        const Vec2d place{dot(from, to_double(coverage_map.across)), dot(from, to_double(coverage_map.down))};
        const Vec2f own{way.x * coverage_map.across.x + way.y * coverage_map.across.y,
                        way.x * coverage_map.down.x + way.y * coverage_map.down.y};
        return coverage_map.coverage(pixel_at(coverage_map, place, 0.03, 0), own).lit;
    };
    const Vec2d along_x{1.05, 1}, along_y{1, 1.05};
    EXPECT_NEAR(lit(along_y, {0, 0}), 1, 0.01);
    EXPECT_NEAR(lit(along_y, {1, 0}), 0.8, 0.02);
    EXPECT_NEAR(lit(along_y, {0, 1}), 1, 0.02);
    EXPECT_NEAR(lit(along_x, {1, 0}), 1, 0.02);
    EXPECT_NEAR(lit(along_x, {0, -2}), 0.6, 0.02);
    EXPECT_NEAR(lit(along_y, {9, 0}), 0, 0.02);
    // Where gaps cross, the Sun aslant of both finds no more.
    EXPECT_NEAR(lit({1, 1}, {9, 9}), 0, 0.02);
}

TEST(CoverageMap, TheGroundStandsForAllInALevelOfDetail) {
    const Mesh mesh = leaning(TiledPanel{}.mesh());
    ObjectSurfaces surfaces = surfaces_of(mesh);
    find_coplanar_groups(mesh, surfaces);
    const auto coverage_maps = std::make_shared<const std::vector<CoverageMap>>(coverage_maps_of(mesh));
    attach_coverage_maps(coverage_maps, mesh, 0.24 * kError_m, surfaces);  // too fine a level
    EXPECT_EQ(surfaces.coverage_maps, nullptr);
    attach_coverage_maps(coverage_maps, mesh, 0.26 * kError_m, surfaces);  // a quarter of a texel
    ASSERT_EQ(surfaces.coverage_maps, coverage_maps);
    const std::uint32_t ground = surfaces.coplanar_groups[0];
    EXPECT_LT(ground, 2u);
    EXPECT_EQ(surfaces.coplanar_groups[1], ground);
    EXPECT_EQ(surfaces.triangles[ground].coplanar_group, 2);
    EXPECT_TRUE(std::all_of(surfaces.coplanar_groups.begin() + 2, surfaces.coplanar_groups.end(),
                            [](std::uint32_t coplanar_group) { return coplanar_group == kNotShown; }));
}

// A ground is cut off along a diagonal, and some tiles stand out over the cut: these are shown by themselves.
TEST(CoverageMap, TilesThatStandOutOfTheGroundAreNoPartOfIt) {
    const TiledPanel panel;
    Mesh mesh = panel.mesh();
    mesh.vertices_m[2] = {static_cast<float>(panel.side_m()), 0.4f, 0};
    ObjectSurfaces surfaces = surfaces_of(mesh);
    find_coplanar_groups(mesh, surfaces);
    const auto coverage_maps = std::make_shared<const std::vector<CoverageMap>>(coverage_maps_of(mesh));
    ASSERT_EQ(coverage_maps->size(), 1u);
    attach_coverage_maps(coverage_maps, mesh, kError_m, surfaces);
    std::size_t hidden = 0;
    for (std::size_t t = 2; t < mesh.triangles.size(); ++t) {
        const auto inside = [&](std::uint32_t v) {
            const Vec3f at = mesh.vertices_m[v];
            return at.y <= 2 - 0.8f * at.x;  // from (0, 2) to (2, 0.4)
        };
        const bool above_ground = std::all_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), inside);
        if (above_ground) {
            EXPECT_EQ(surfaces.coplanar_groups[t], kNotShown) << t;
        }
        const Vec3f at = mesh.vertices_m[mesh.triangles[t][2]];
        if (at.y > 2.02f - 0.8f * at.x) {
            EXPECT_NE(surfaces.coplanar_groups[t], kNotShown) << t;
        }
        hidden += surfaces.coplanar_groups[t] == kNotShown;
    }
    EXPECT_GT(hidden, 400u);
    EXPECT_LT(hidden, 600u);
}

TEST(CoverageMap, IsTheSameByAnyWidthOfVectors) {
    const CoverageMap coverage_map = coverage_maps_of(leaning(TiledPanel{}.mesh())).at(0);
    expect_same_by_any_width([&] {
        std::vector<float> out;
        for (int i = 0; i < 50; ++i) {
            const CoverageMap::Coverage look = coverage_map.coverage(
                pixel_at(coverage_map, {0.3 + 0.03 * i, 0.2 + 0.02 * i}, 0.01 + 0.003 * i, 0.1 * i), {1, -2});
            for (std::size_t k = 0; k < coverage_map.layers; ++k)
                out.insert(out.end(), {look.share[k], look.place[k].x, look.place[k].y});
            out.insert(out.end(), {look.lit, look.lean.x, look.lean.y});
        }
        return out;
    });
}

}  // namespace
}  // namespace hilcam
