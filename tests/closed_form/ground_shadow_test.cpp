// Shadows on the ground of a whole body (render/ground/globe_terrain.h) against what geometry says: how long one is at a low Sun,
// how wide its half-shadow, and where day ends, on a sphere and on a mountain.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "render/ground/cube_sphere.h"
#include "render/ground/globe_terrain.h"
#include "tests/support/ground_maps.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr Figure kMoonFigure = kFigures[index_of(BodyId::kMoon)];
constexpr double kRadius_m = kMoonFigure.equatorial_radius_m;

// Ground whose height is a function of the way east and north of a place.
class MadeGround final : public GroundDetail {
  public:
    MadeGround(Vec3d up, std::function<double(double east_m, double north_m)> height_m)
        : up_(up), axes_(axes_along(up)), height_m_(std::move(height_m)) {}
    void add(const GroundPatch& patch) const override {
        for (std::size_t i = 0; i < patch.places.size(); ++i) {
            const double ahead = dot(patch.places[i], up_);
            if (!(ahead > 0.9)) continue;
            // Along the ground, not along the tangent.
            const double east = dot(patch.places[i], axes_.east), north = dot(patch.places[i], axes_.north);
            const double off = std::hypot(east, north), scale = off > 0 ? std::atan2(off, ahead) / off : 1;
            patch.heights_m[i] += height_m_(kRadius_m * scale * east, kRadius_m * scale * north);
        }
    }

  private:
    Vec3d up_;
    AlongGround axes_;
    std::function<double(double, double)> height_m_;
};

// A camera that looks straight down on the ground east of a place; columns of its picture go along the way east.
struct Scenery {
    Stage stage;
    Vec3d up = place_on_sphere(20, 5), east = axes_along(up).east;
    double pixel_m, above_m, middle_m;

    // elevation_rad: the Sun's in the west, over the horizontal of the place. middle_m: of the picture, east of it.
    Scenery(double elevation_rad, double wide_m, double middle_east_m,
            std::function<double(double, double)> height_m, bool disk)
        : middle_m(middle_east_m) {
        constexpr int kSide_px = 256;
        pixel_m = wide_m / kSide_px, above_m = 2 * wide_m;
        stage.camera(kSide_px, 0.25);
        stage.quality.path_model = "direct";
        stage.quality.max_depth = 1;
        stage.quality.sun_disk = disk;
        if (disk) stage.quality.samples_per_axis = 4;  // each ray asks one point of the disk
        stage.scene.limb_darkening = false;
        std::vector<std::unique_ptr<const GroundDetail>> details;
        details.push_back(std::make_unique<MadeGround>(up, std::move(height_m)));
        stage.scene.terrain = std::make_unique<SceneTerrain>();
        stage.scene.terrain->ground = std::make_unique<GlobeTerrain>(kMoonFigure, std::vector<GroundMap>{},
                                                                     std::move(details), GlobeSettings{});
        stage.scene.terrain->material = make_material(lambert(0.5), stage.grid);
        stage.scene.terrain->edge_px = 1;
        stage.scene.terrain->max_triangles = 4'000'000;
        const double turn = middle_m / kRadius_m;
        const Vec3d below = std::cos(turn) * up + std::sin(turn) * east;
        stage.world.camera.position_world_m = (kRadius_m + above_m) * below;
        // The picture's right is along the way east.
        stage.world.camera.world_from_body = look_along(-1.0 * below, cross(below, east));
        stage.sun(std::sin(elevation_rad) * up - std::cos(elevation_rad) * east);
        stage.render();
    }
    // Where the middle of a column meets the ground of height 0, east of the place [m].
    double east_m(double column) const {
        const double off =
            std::atan((column - 0.5 * stage.radiance.width()) / stage.geometry.focal_length_px);
        // The sphere falls away from the tangent: the angle at its centre by the law of sines.
        const double at_ground = kPi - std::asin((kRadius_m + above_m) / kRadius_m * std::sin(std::abs(off)));
        const double turn = kPi - at_ground - std::abs(off);
        return middle_m + std::copysign(kRadius_m * turn, off);
    }
    // The sunlight of a column over that of flat ground, as a mean over rows about the middle one.
    double light(int column) const {
        const int half = stage.radiance.height() / 2;
        constexpr int kRows = 64;
        double sum = 0;
        for (int y = half - kRows; y < half + kRows; ++y)
            sum += static_cast<double>(stage.radiance.row(y)[static_cast<std::size_t>(column)]);
        return sum / (2 * kRows);
    }
};

// A ridge from north to south of 100 m, which is wide against the mesh's triangles and narrow against its shadow.
struct Ridge {
    double wide_m;
    double height_m(double east_m) const {
        return kHeight_m * std::exp(-0.5 * east_m * east_m / (wide_m * wide_m));
    }
    double elevation_rad(double east_m) const;
    double shadow_m(double sun_rad) const;
    static constexpr double kHeight_m = 100;
};

// Returns how high it stands over the horizontal of a place east of it, which the body's curve has turned: by its highest line of
// sight.
double Ridge::elevation_rad(double east_m) const {
    double most = -kPi;
    for (double at_m = -2 * wide_m; at_m < 2 * wide_m; at_m += 0.05) {
        const double turn = (east_m - at_m) / kRadius_m, top_m = kRadius_m + height_m(at_m);
        if (turn > 0)
            most = std::max(most, std::atan2(top_m * std::cos(turn) - kRadius_m, top_m * std::sin(turn)));
    }
    return most;
}
// Returns where its shadow ends: there it stands as high as the Sun's point does, which the way east has lowered.
double Ridge::shadow_m(double sun_rad) const {
    double dark_m = 2 * wide_m, lit_m = 2 * kHeight_m / std::tan(sun_rad);
    while (lit_m - dark_m > 1e-3) {
        const double middle_m = 0.5 * (dark_m + lit_m);
        (elevation_rad(middle_m) > sun_rad - middle_m / kRadius_m ? dark_m : lit_m) = middle_m;
    }
    return lit_m;
}

double sun_radius_rad() { return std::asin(kSunRadius_m / kAstronomicalUnit_m); }

// The edge of a ridge's shadow, where half of the flat ground's light is reached, at three elevations: with the body's curve, which at
// 3 deg is 20 m of 1.9 km.
TEST(GroundShadow, ARidgesShadowIsAsLongAsGeometrySays) {
    for (const auto& [elevation_deg, wide_m] : {std::pair{3.0, 200.0}, {10.0, 60.0}, {30.0, 40.0}}) {
        const Ridge ridge{wide_m};
        const double elevation_rad = elevation_deg * kDegree_rad, expected_m = ridge.shadow_m(elevation_rad);
        // The ridge is in the picture, too: beside it the ground is coarser.
        const Scenery s(
            elevation_rad, 1.4 * expected_m, 0.6 * expected_m,
            [&](double east_m, double) { return ridge.height_m(east_m); }, false);
        const int last = s.stage.radiance.width() - 1;
        const double flat = s.light(last - 4);
        ASSERT_GT(flat, 0);
        int column = last / 2;
        ASSERT_EQ(s.light(column), 0) << elevation_deg;
        while (s.light(column) < 0.5 * flat) ++column;
        // Between the middles of two columns.
        const double before = s.light(column - 1), after = s.light(column);
        const double edge_m = s.east_m(column - 0.5 + (0.5 * flat - before) / (after - before));
        std::printf("shadow at %2.0f deg: %.2f m, geometry %.2f m, a pixel is %.2f m\n", elevation_deg,
                    edge_m, expected_m, s.pixel_m);
        EXPECT_NEAR(edge_m, expected_m, s.pixel_m) << elevation_deg;
    }
}

// The share of an even disk that stands above an edge, which is so many radii below its middle.
double share_above(double edge) {
    if (edge >= 1) return 0;
    if (edge <= -1) return 1;
    return (std::acos(edge) - edge * std::sqrt(1 - edge * edge)) / kPi;
}

// Through the half-shadow the light grows as the part of the Sun's disk does that stands above the ridge.
TEST(GroundShadow, AHalfShadowHasTheSunsDisk) {
    const double elevation_rad = 10 * kDegree_rad;
    const Ridge ridge{60};
    const double from_m = ridge.shadow_m(elevation_rad + sun_radius_rad()),
                 to_m = ridge.shadow_m(elevation_rad - sun_radius_rad());
    const Scenery s(
        elevation_rad, 1.3 * to_m, 0.6 * to_m, [&](double east_m, double) { return ridge.height_m(east_m); },
        true);
    const double flat = s.light(s.stage.radiance.width() - 5);
    ASSERT_GT(flat, 0);
    double sum2 = 0, most = 0;
    int columns = 0;
    for (int column = 0; column < s.stage.radiance.width(); ++column) {
        const double east_m = s.east_m(column + 0.5);
        if (east_m < from_m - (to_m - from_m)) continue;
        const double expected = share_above(
            (ridge.elevation_rad(east_m) - (elevation_rad - east_m / kRadius_m)) / sun_radius_rad());
        const double error = s.light(column) / flat - expected;
        sum2 += error * error, most = std::max(most, std::abs(error)), ++columns;
    }
    std::printf("half-shadow %.2f m wide: root mean square %.4f of the light, most %.4f\n", to_m - from_m,
                std::sqrt(sum2 / columns), most);
    EXPECT_LT(std::sqrt(sum2 / columns), 0.02);
    EXPECT_LT(most, 0.06);
}

// Day ends on a smooth sphere where the Sun's upper limb sets, and its light falls to there as the disk's over the horizontal.
TEST(GroundShadow, DayEndsWhereTheSunsLimbSets) {
    const double radius_rad = sun_radius_rad();
    // The place is 90 deg from the point below the Sun: its middle is on the horizon there.
    const Scenery s(
        0, 4 * radius_rad * kRadius_m, 0, [](double, double) { return 0.0; }, true);
    int last_lit = -1;
    for (int column = 0; column < s.stage.radiance.width(); ++column)
        if (s.light(column) > 0) last_lit = column;
    const double end_m = s.east_m(last_lit + 1), expected_m = radius_rad * kRadius_m;
    std::printf("day ends %.0f m behind the terminator, geometry %.0f m, a pixel is %.0f m\n", end_m,
                expected_m, s.pixel_m);
    // The last degree of the disk has a thousandth of the light.
    EXPECT_GT(end_m, 0.8 * expected_m);
    EXPECT_LT(end_m, expected_m + 2 * s.pixel_m);
    // By a point it ends at its middle.
    const Scenery point(
        0, 4 * radius_rad * kRadius_m, 0, [](double, double) { return 0.0; }, false);
    last_lit = -1;
    for (int column = 0; column < point.stage.radiance.width(); ++column)
        if (point.light(column) > 0) last_lit = column;
    EXPECT_NEAR(point.east_m(last_lit + 1), 0, 2 * point.pixel_m);
}

// A mountain in the night is lit as far as its height lifts it: from the turn at which (R + h) cos(turn) is R.
TEST(GroundShadow, AMountainsTopIsLitAsFarAsItsHeightLiftsIt) {
    constexpr double kHeight_m = 4000, kWide_m = 6000;
    const double reach_rad = std::acos(kRadius_m / (kRadius_m + kHeight_m));
    const auto lit_m = [&](double turn_rad) {
        // The place is on the mountain; the Sun stands below its horizon by the turn.
        const Scenery s(
            -turn_rad, 2 * kWide_m, 0,
            [&](double east_m, double north_m) {
                return kHeight_m * std::exp(-4 * (east_m * east_m + north_m * north_m) / (kWide_m * kWide_m));
            },
            false);
        double lit = 0;
        for (const float value : s.stage.radiance.plane(0)) lit += value > 0 ? s.pixel_m * s.pixel_m : 0;
        return std::sqrt(lit);
    };
    const double before_m = lit_m(0.8 * reach_rad), near_m = lit_m(0.97 * reach_rad),
                 beyond_m = lit_m(1.01 * reach_rad);
    std::printf(
        "mountain of %.0f m, which reaches %.3f deg: lit %.0f, %.0f and %.0f m wide at 0.8, 0.97 and 1.01 of "
        "it\n",
        kHeight_m, reach_rad / kDegree_rad, before_m, near_m, beyond_m);
    EXPECT_GT(before_m, 2 * near_m);
    EXPECT_GT(near_m, 0);
    EXPECT_EQ(beyond_m, 0);
    // What is lit at 0.8 of the reach is above the height that reaches there, on the Sun's side: half a disk of that radius.
    const double low_m = kRadius_m / std::cos(0.8 * reach_rad) - kRadius_m;
    const double radius_m = 0.5 * kWide_m * std::sqrt(std::log(kHeight_m / low_m));
    EXPECT_NEAR(before_m, radius_m * std::sqrt(0.5 * kPi), 0.15 * before_m);
}

}  // namespace
}  // namespace hilcam
