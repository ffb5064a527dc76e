// Which tiles a frame needs: all that the looks of its pixels are at, few beside, and never more than there is room for.

#include "render/earth/detail_need.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/earth/earth_model.h"
#include "render/earth/map_looks.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"
#include "tests/support/earth_detail_stage.h"

namespace hilcam {
namespace {

constexpr Figure kEarthFigure = kFigures[index_of(BodyId::kEarth)];

Vec3d place_m(double longitude_deg, double latitude_deg, double height_m) {
    const double lon = longitude_deg * kDegree_rad, lat = latitude_deg * kDegree_rad;
    return (kEarthFigure.equatorial_radius_m + height_m) *
           Vec3d{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

struct Pose {
    Vec3d camera_m, boresight;
};
// tilt_deg: from straight down, towards the north.
Pose pose(double longitude_deg, double latitude_deg, double height_m, double tilt_deg) {
    const Vec3d camera_m = place_m(longitude_deg, latitude_deg, height_m), up = normalized(camera_m);
    const Vec3d north = normalized(Vec3d{0, 0, 1} - up.z * up);
    const double tilt = tilt_deg * kDegree_rad;
    return {camera_m, std::sin(tilt) * north - std::cos(tilt) * up};
}

// The tiles that the looks of a square picture's pixels take, at both of their levels.
struct Looked {
    std::vector<DetailKey> tiles;
    std::size_t looks = 0;
};
Looked looked_at(const EarthModel& earth, const EarthDetail::Shape& shape, const Pose& p, int size_px,
                 double pixel_rad) {
    const Vec3d right =
        normalized(cross(p.boresight, std::abs(p.boresight.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}));
    const Vec3d down = cross(p.boresight, right);
    Looked out;
    for (int y = 0; y < size_px; y += 3)
        for (int x = 0; x < size_px; x += 3) {
            const Vec3d dir = normalized(
                p.boresight + pixel_rad * ((x + 0.5 - size_px / 2) * right + (y + 0.5 - size_px / 2) * down));
            EarthAspect aspect;
            if (!earth.aspect_of({p.camera_m, dir, normalized(p.camera_m), pixel_rad, {}}, aspect)) continue;
            each_look(aspect.u, aspect.v, aspect.footprint,
                      {static_cast<float>(shape.columns), static_cast<float>(shape.rows)},
                      [&](float u, float v, float level, float) {
                          for (const int at : {static_cast<int>(level), static_cast<int>(level) + 1}) {
                              if (at >= shape.levels) continue;
                              ++out.looks;
                              const float turn = u - std::floor(u);
                              const auto tile = [&](float share, int cells) {
                                  return static_cast<int>(
                                             std::max(0.0f, share * static_cast<float>(cells) - 0.5f)) /
                                         EarthDetail::kTile;
                              };
                              out.tiles.push_back(
                                  {at, tile(turn, shape.columns_at(at)), tile(v, shape.rows_at(at))});
                          }
                      });
        }
    const auto order = [](const DetailKey& k) { return std::array{k.level, k.column, k.row}; };
    std::sort(out.tiles.begin(), out.tiles.end(), [&](auto& a, auto& b) { return order(a) < order(b); });
    out.tiles.erase(std::unique(out.tiles.begin(), out.tiles.end()), out.tiles.end());
    return out;
}

struct DetailNeedTest : testing::Test {
    SpectralGrid grid{std::vector<double>{0.4, 0.7}};
    EarthModel earth{EarthConfig{}, noise_map(16), EarthMap(), nullptr, grid};
    EarthDetail::Shape shape = EarthDetail::shape_above(86400, 43200, 2048);
    static constexpr int kSize_px = 1024;

    DetailView view(const Pose& p, double pixel_rad) const {
        return {p.camera_m, p.boresight, normalized(p.camera_m),
                std::atan(0.5 * std::sqrt(2.0) * kSize_px * pixel_rad), pixel_rad};
    }
};

TEST_F(DetailNeedTest, HasAllThatPixelsLookAt) {
    std::size_t looked = 0, needed = 0;
    DetailNeed need(shape, 100'000);
    for (const double pixel_rad : {4e-4, 1e-3})
        for (const Pose& p : {pose(12, 40, 420e3, 0), pose(179.8, -20, 420e3, 30), pose(-100, 72, 600e3, 62),
                              pose(30, 89.9, 700e3, 10), pose(0, -3, 300e3, 68), pose(77, 13, 2000e3, 20)}) {
            const Looked all = looked_at(earth, shape, p, kSize_px, pixel_rad);
            ASSERT_GT(all.looks, 1000u);
            need.find(view(p, pixel_rad));
            EXPECT_EQ(need.coarser_by(), 0);
            for (const DetailKey& key : all.tiles)
                EXPECT_NE(std::find(need.tiles().begin(), need.tiles().end(), key), need.tiles().end())
                    << key.level << " " << key.column << " " << key.row << " from " << p.camera_m.x;
            looked += all.tiles.size(), needed += need.tiles().size();
        }
    // A cone about a square field, caps about square tiles, and the levels above.
    EXPECT_LT(needed, 3 * looked);
    std::printf("looked at %zu tiles, needed %zu\n", looked, needed);
}

TEST_F(DetailNeedTest, LessRoomMakesAllOfItCoarser) {
    const DetailView wide = view(pose(12, 40, 420e3, 40), 4e-4);
    DetailNeed plenty(shape, 100'000), little(shape, 60), none(shape, 1);
    plenty.find(wide), little.find(wide), none.find(wide);
    EXPECT_GT(plenty.tiles().size(), 60u);
    EXPECT_LE(little.tiles().size(), 60u);
    EXPECT_GT(little.tiles().size(), 10u);
    EXPECT_GT(little.coarser_by(), 0);
    EXPECT_LE(none.tiles().size(), 1u);
}

TEST_F(DetailNeedTest, NothingIsNeededOfAnEarthThatIsNotSeen) {
    DetailNeed need(shape, 1000);
    const Pose p = pose(12, 40, 420e3, 180);
    need.find(view(p, 4e-4));
    // The spheres about the coarsest ones below hold the camera.
    EXPECT_LT(need.tiles().size(), 40u);
    for (const DetailKey& key : need.tiles()) EXPECT_GE(key.level, 2);
    // From afar the map in memory is fine enough.
    need.find(view(pose(12, 40, 42164e3, 0), 1e-3));
    EXPECT_TRUE(need.tiles().empty());
}

}  // namespace
}  // namespace hilcam
