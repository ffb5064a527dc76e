// What a frame shows, against closed forms: nothing here asks the renderer where things are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/sky/bodies.h"
#include "tests/support/truth_stage.h"

namespace hilcam {
namespace {

// A cube of 1 m, its front face 3.5 m away: 64 -+ 0.5 / 3.5 * 128 = 45.71 .. 82.29 px. Middles of pixels 46
// to 81 lie inside; the other faces hide behind that one.
TEST(Truth, ACubeBeforeTheCameraHasItsDepthNormalAndBox) {
    TruthStage s;
    s.add(cube(lambert(0.5), s.grid), {0, 0, 4}, {});
    s.sun({3, 0, -4});
    const FrameTruth t = s.tell();
    // The cube, the Sun.
    ASSERT_EQ(t.things.size(), 2u);
    const SeenThing& thing = t.things[0];
    EXPECT_EQ(thing.id, 1u);
    expect_near(thing.position_camera_m, {0, 0, 4}, 1e-12);
    EXPECT_NEAR(thing.distance_m, 4, 1e-12);
    ASSERT_TRUE(thing.has_center);
    EXPECT_NEAR(thing.center_px.x, 64, 1e-9);
    EXPECT_NEAR(thing.center_px.y, 64, 1e-9);
    // From the cube the Sun is off the camera's direction by atan(3/4); an au makes 4 m nothing.
    EXPECT_NEAR(thing.phase_rad, std::atan2(3, 4), 1e-9);
    EXPECT_EQ(thing.sunlit, 1);
    EXPECT_EQ(thing.visible_px, 36u * 36u);
    expect_box(thing.visible_box_px, {46, 46, 82, 82});
    EXPECT_NEAR(thing.visible_center_px.x, 64, 1e-9);
    EXPECT_EQ(thing.silhouette_px, 36.0 * 36.0);
    expect_box(thing.silhouette_box_px, {46, 46, 82, 82});
    EXPECT_EQ(thing.visible_fraction, 1);
    EXPECT_FALSE(thing.silhouette_cut);

    // The middle of pixel (70, 60) is (6.5, -3.5) px off the boresight. Single precision: 6e-8 of 3.5 m, some
    // roundings.
    const double x = 6.5 / 128, y = -3.5 / 128;
    EXPECT_EQ(value_at(t.layers.object, 70, 60), 1u);
    EXPECT_NEAR(value_at(t.layers.depth_m, 70, 60), 3.5, 2e-6);
    EXPECT_NEAR(value_at(t.layers.range_m, 70, 60), 3.5 * std::sqrt(1 + x * x + y * y), 2e-6);
    expect_near(vector_at(t.layers.position_m, 70, 60), {3.5 * x, 3.5 * y, 3.5}, 2e-6);
    expect_near(vector_at(t.layers.normal, 70, 60), {0, 0, -1}, 1e-6);
    EXPECT_EQ(value_at(t.layers.object, 45, 64), kSkyId);
    EXPECT_TRUE(std::isinf(value_at(t.layers.depth_m, 45, 64)));
    EXPECT_TRUE(std::isinf(value_at(t.layers.range_m, 45, 64)));
    expect_near(vector_at(t.layers.normal, 45, 64), {}, 0);

    expect_near(t.sun_camera_dir, {0.6, 0, -0.8}, 1e-12);
    EXPECT_NEAR(t.sun_distance_m / kAstronomicalUnit_m, 1, 1e-12);
}

// The camera is turned about its boresight and the cube with it in the world: nothing changes in its axes.
TEST(Truth, DirectionsAndAttitudesAreInTheCamerasAxes) {
    TruthStage s;
    const Quat turn = from_rotation_vector({0.3, -0.8, 1.1});
    const Mat3d world_from_camera = to_matrix(turn);
    s.world.camera = {{1e7, -2e7, 3e6}, turn};
    s.add(cube(lambert(0.5), s.grid), {}, {});
    s.world.objects[0] = {s.world.camera.position_world_m + world_from_camera * Vec3d{0.5, 0.25, 4},
                          turn * from_rotation_vector({0, 0, 0.2})};
    s.world.bodies.sun_world_m =
        s.world.camera.position_world_m + kAstronomicalUnit_m * (world_from_camera * Vec3d{0, -0.6, -0.8});
    const FrameTruth t = s.tell();
    const SeenThing& thing = t.things[0];
    // 1e7 m in double precision: 4e-9 m.
    expect_near(thing.position_camera_m, {0.5, 0.25, 4}, 1e-8);
    const Mat3d camera_from_thing = to_matrix(thing.camera_from_thing);
    expect_near(camera_from_thing * Vec3d{1, 0, 0}, {std::cos(0.2), std::sin(0.2), 0}, 1e-12);
    EXPECT_NEAR(thing.center_px.x, 64 + 128 * 0.125, 1e-6);
    EXPECT_NEAR(thing.center_px.y, 64 + 128 * 0.0625, 1e-6);
    expect_near(t.sun_camera_dir, {0, -0.6, -0.8}, 1e-9);
    expect_near(vector_at(t.layers.normal, 80, 72), {0, 0, -1}, 1e-6);
    EXPECT_NEAR(value_at(t.layers.depth_m, 80, 72), 3.5, 2e-6);
}

// A plate 2 m before the camera, from 2 m left of the boresight up to it: it covers the frame's left half,
// and as much again beside the frame.
TEST(Truth, WhatIsHalfHiddenAndWhatIsHalfOutsideAreHalfVisible) {
    TruthStage s;
    s.add(cube(lambert(0.5), s.grid), {0, 0, 4}, {});
    s.add(plate(lambert(0.5), s.grid), {-1, 0, 2});
    const FrameTruth t = s.tell();
    const SeenThing &behind = t.things[0], &before = t.things[1];
    EXPECT_EQ(behind.visible_px, 18u * 36u);
    expect_box(behind.visible_box_px, {64, 46, 82, 82});
    EXPECT_NEAR(behind.visible_center_px.x, 73, 1e-9);
    EXPECT_EQ(behind.silhouette_px, 36.0 * 36.0);
    expect_box(behind.silhouette_box_px, {46, 46, 82, 82});
    EXPECT_EQ(behind.visible_fraction, 0.5);

    EXPECT_EQ(before.id, 2u);
    EXPECT_EQ(before.visible_px, 64u * 128u);
    // Beside the frame a ray may stand for 2 x 2 px, whose sides are those of the plate here.
    EXPECT_EQ(before.silhouette_px, 128.0 * 128.0);
    EXPECT_NEAR(before.silhouette_box_px.x0, -64, 2);
    EXPECT_EQ(before.silhouette_box_px.x1, 64);
    EXPECT_EQ(before.visible_fraction, 0.5);
    EXPECT_FALSE(before.silhouette_cut);
    EXPECT_EQ(value_at(t.layers.object, 63, 64), 2u);
    EXPECT_EQ(value_at(t.layers.object, 64, 64), 1u);
    EXPECT_NEAR(value_at(t.layers.depth_m, 63, 64), 2, 2e-6);
}

// The same two, and a cube of 8 px, small for the truth, half behind the plate.
TEST(Truth, PixelSilhouettesHaveWhatIsHiddenAndWhatIsSmall) {
    TruthStage s;
    s.request.silhouettes = true;
    s.add(cube(lambert(0.5), s.grid), {0, 0, 4}, {});
    s.add(plate(lambert(0.5), s.grid), {-1, 0, 2});
    s.add(cube(lambert(0.5), s.grid, 0.1875f), {0, 0, 3}, {});
    const FrameTruth t = s.tell();
    ASSERT_EQ(t.silhouettes.size(), 3u);
    // The small cube's face of 0.1875 m at 2.90625 m: 64 -+ 4.13 px, the middles of 8 pixels.
    const PixelSilhouette &behind = t.silhouettes[0], &before = t.silhouettes[1], &small = t.silhouettes[2];
    EXPECT_EQ(behind.thing, 1u);
    EXPECT_EQ(behind.px, 36u * 36u);
    expect_box(behind.box_px, {46, 46, 82, 82});
    EXPECT_EQ(behind.hidden_px.size(), 18u * 36u + 4u * 8u);
    EXPECT_EQ(behind.hidden_px.front(), 46u * 128u + 46u);
    EXPECT_TRUE(std::is_sorted(behind.hidden_px.begin(), behind.hidden_px.end()));
    EXPECT_EQ(before.px, 128u * 128u);
    EXPECT_TRUE(before.hidden_px.empty());
    EXPECT_EQ(small.px, 8u * 8u);
    expect_box(small.box_px, {60, 60, 68, 68});
    EXPECT_EQ(small.hidden_px.size(), 4u * 8u);
    for (const std::uint32_t px : small.hidden_px) EXPECT_LT(px % 128, 64u);
    EXPECT_EQ(t.things[2].visible_px, 4u * 8u);
}

TEST(Truth, WhatIsWhollyHiddenOrBehindTheCameraIsNotVisible) {
    TruthStage s;
    s.add(cube(lambert(0.5), s.grid), {-1, 0, 4}, {});
    s.add(plate(lambert(0.5), s.grid), {-1, 0, 2});
    s.add(cube(lambert(0.5), s.grid), {0, 0, -4}, {});
    const FrameTruth t = s.tell();
    EXPECT_EQ(t.things[0].visible_px, 0u);
    EXPECT_TRUE(t.things[0].visible_box_px.empty());
    EXPECT_GT(t.things[0].silhouette_px, 0);
    EXPECT_EQ(t.things[0].visible_fraction, 0);
    EXPECT_FALSE(t.things[2].has_center);
    EXPECT_EQ(t.things[2].silhouette_px, 0);
    EXPECT_TRUE(std::isnan(t.things[2].visible_fraction));
}

// Far away against its size, so that rays begin at it; the body has the whole picture looked at.
TEST(Truth, WhatIsFarBehindTheCameraIsNotMetWhereABodyFillsThePicture) {
    TruthStage s;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 10e6};
    s.add(plate(lambert(0.5), s.grid), {0, 0, -100}, {});
    const FrameTruth t = s.tell();
    const SeenThing& behind = t.things.at(0);
    EXPECT_EQ(behind.id, 1u);
    EXPECT_EQ(behind.visible_px, 0u);
    EXPECT_EQ(value_at(t.layers.object, 64, 64), truth_id(BodyId::kEarth));
}

TEST(Truth, ASilhouetteThatGoesOnIsMarked) {
    TruthStage s;
    SceneObject wall = plate(lambert(0.5), s.grid);
    for (Vec3f& v : wall.mesh.vertices_m) v = 100.0f * v;
    s.add(std::move(wall), {0, 0, 10});
    const SeenThing thing = s.tell().things[0];
    EXPECT_TRUE(thing.silhouette_cut);
    // All of the canvas.
    EXPECT_EQ(thing.silhouette_px, 9.0 * 128 * 128);
    EXPECT_NEAR(thing.visible_fraction, 1.0 / 9, 1e-12);
}

// Of a sphere of facets the truth lies between the sphere and the one that its facets leave inside: corners
// are pi / 64 apart, a facet's middle at most that over sqrt 2 from one, 1 - cos(0.0347) = 6.0e-4 below it.
TEST(Truth, ASphereHasItsOutlineDepthAndNormals) {
    TruthStage s;
    s.add(sphere(64, lambert(0.5), s.grid), {0.5, -0.25, 5}, {});
    const FrameTruth t = s.tell();
    constexpr double kInside = 6.1e-4;
    const Vec3d middle{0.5, -0.25, 5};
    // Distance along the unit direction through a pixel's middle, or negative.
    const auto distance = [&](double x, double y, double radius) {
        const Vec3d d = normalized(Vec3d{(x - 64) / 128, (y - 64) / 128, 1});
        const double along = dot(d, middle), rest = radius * radius - dot(middle, middle) + along * along;
        return rest < 0 ? -1.0 : along - std::sqrt(rest);
    };
    std::uint64_t least = 0, most = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            least += distance(x + 0.5, y + 0.5, 1 - kInside) >= 0 ? 1u : 0u;
            most += distance(x + 0.5, y + 0.5, 1) >= 0 ? 1u : 0u;
        }
    const SeenThing& thing = t.things[0];
    EXPECT_GE(thing.visible_px, least);
    EXPECT_LE(thing.visible_px, most);
    EXPECT_GT(least, 2000u);  // pi (tan(asin(1 / 5.03)) 128)^2, about
    EXPECT_EQ(thing.visible_fraction, 1);
    EXPECT_NEAR(thing.center_px.x, 64 + 128 * 0.1, 1e-9);
    EXPECT_NEAR(thing.center_px.y, 64 - 128 * 0.05, 1e-9);
    for (const auto& [x, y] : {std::array{77, 57}, std::array{85, 60}, std::array{70, 45}}) {
        const double there = distance(x + 0.5, y + 0.5, 1), inside = distance(x + 0.5, y + 0.5, 1 - kInside);
        EXPECT_GE(value_at(t.layers.range_m, x, y), there - 2e-6);
        EXPECT_LE(value_at(t.layers.range_m, x, y), inside + 2e-6);
        const Vec3d d = normalized(Vec3d{(x + 0.5 - 64) / 128, (y + 0.5 - 64) / 128, 1});
        // Between corners normals are mixed: off by an eighth of the square of their angle, 3e-4, and by how
        // far a facet shifts the point against its normal, less than the facet's own 6e-4 over the cosine.
        expect_near(vector_at(t.layers.normal, x, y), there * d - middle, 3e-3);
    }
}

// A body below some pixels: the picture has it as points, and few pixels' middles meet it.
TEST(Truth, AThingOfAFewPixelsIsMeasuredFinely) {
    TruthStage s;
    s.add(sphere(64, lambert(0.5), s.grid), {0, 0, 100}, {});
    s.add(plate(lambert(0.5), s.grid), {-1, 0, 2});
    const FrameTruth t = s.tell();
    const SeenThing& thing = t.things[0];
    // 1.28 px of radius: 570 of the fine rays. The outline passes some 90 of their cells; were it wrong in a
    // tenth of them, it would be 9 of 570.
    EXPECT_NEAR(thing.silhouette_px, kPi * 1.28 * 1.28, 0.016 * 5.15);
    // The plate's edge lies on the boresight, between two columns of rays.
    EXPECT_NEAR(thing.visible_fraction, 0.5, 0.02);
    // Half a disk's centroid is 4 r / 3 pi off its straight side; a column of rays is 0.1 px wide.
    EXPECT_NEAR(thing.visible_center_px.x, 64 + 4 * 1.28 / (3 * kPi), 0.05);
    EXPECT_NEAR(thing.visible_center_px.y, 64, 0.02);
    // The middles of (64, 63) and (64, 64) are 0.7 px off.
    EXPECT_EQ(value_at(t.layers.object, 64, 64), 1u);
    EXPECT_EQ(value_at(t.layers.object, 63, 64), 2u);
    EXPECT_NEAR(value_at(t.layers.depth_m, 64, 64), 99, 0.5);
    EXPECT_FALSE(s.points.empty());
}

// Parts that turn belong to their object: of its box, its pixels and its number.
TEST(Truth, PartsCountAsTheirObject) {
    TruthStage s;
    s.add(cube(lambert(0.5), s.grid), {-0.5, 0, 4}, {});
    s.add(cube(lambert(0.5), s.grid), {0, 0, -5}, {});
    s.add(cube(lambert(0.5), s.grid), {0.5, 0, 4}, {});
    s.request.thing_of_object = {0, 1, 0};
    const FrameTruth t = s.tell();
    ASSERT_EQ(t.things.size(), 3u);
    // Front faces from 64 - 1 / 3.5 * 128 = 27.4 to 100.6 px.
    expect_box(t.things[0].visible_box_px, {27, 46, 101, 82});
    EXPECT_EQ(t.things[0].visible_px, 74u * 36u);
    EXPECT_EQ(t.things[0].visible_fraction, 1);
    ASSERT_EQ(t.parts.size(), 1u);
    EXPECT_EQ(t.parts[0].thing, 1u);
    EXPECT_EQ(t.parts[0].object, 2u);
    expect_near(t.parts[0].position_camera_m, {0.5, 0, 4}, 1e-12);
    EXPECT_EQ(value_at(t.layers.object, 80, 64), 1u);
}

// The Earth from over its north pole, as an ellipsoid in closed form.
TEST(Truth, ABodyHasItsNumberRangeAndNormal) {
    TruthStage s;
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 42e6};
    const FrameTruth t = s.tell();
    const SeenThing& earth = t.things.back();
    EXPECT_EQ(earth.id, 1000399u);
    EXPECT_TRUE(earth.is_body);
    EXPECT_NEAR(earth.distance_m, 42e6, 1e-6);
    const double a = kEarthEquatorialRadius_m, b = a * (1 - kEarthFlattening);
    const double x = 8.5 / 128, y = 4.5 / 128;
    // (t x)^2 / a^2 + (t y)^2 / a^2 + (t - 42e6)^2 / b^2 = 1.
    const double qa = (x * x + y * y) / (a * a) + 1 / (b * b), qb = -2 * 42e6 / (b * b),
                 qc = 42e6 * 42e6 / (b * b) - 1;
    const double z = (-qb - std::sqrt(qb * qb - 4 * qa * qc)) / (2 * qa);
    EXPECT_EQ(value_at(t.layers.object, 72, 68), 1000399u);
    EXPECT_NEAR(value_at(t.layers.depth_m, 72, 68), z, 4);  // single precision: 2 m
    EXPECT_NEAR(value_at(t.layers.range_m, 72, 68), z * std::sqrt(1 + x * x + y * y), 4);
    const Vec3d normal = normalized(Vec3d{z * x / (a * a), z * y / (a * a), (z - 42e6) / (b * b)});
    expect_near(vector_at(t.layers.normal, 72, 68), normal, 1e-6);
    // From over the pole its outline is a circle: the tangents to the ellipse have the slope a / sqrt(D^2 -
    // b^2). Its 1214 pixels make the lattice's own error, a few of them, 0.1 px of the radius.
    const double radius_px = 128 * a / std::sqrt(42e6 * 42e6 - b * b);
    EXPECT_NEAR(std::sqrt(static_cast<double>(earth.visible_px) / kPi), radius_px, 0.2);
    EXPECT_EQ(earth.visible_fraction, 1);
    EXPECT_EQ(t.things[t.things.size() - 2].id, kSunId);
}

// Share of a disk of radius 1 that one of radius r, whose middle is d away, leaves of it.
double left_of_disk(double d, double r) {
    const double hidden = std::acos((d * d + 1 - r * r) / (2 * d)) +
                          r * r * std::acos((d * d + r * r - 1) / (2 * d * r)) -
                          0.5 * std::sqrt((-d + 1 + r) * (d + 1 - r) * (d - 1 + r) * (d + 1 + r));
    return 1 - hidden / kPi;
}

// The Moon, 16 degrees wide, before an evenly bright Sun, from all sides. Near the Sun its limb is curved as
// a circle of tan(half its width). The program looks at 288 places of the disk; 0.014 is what limbs of all
// kinds cost at most.
TEST(Truth, InThePenumbraTheSunlitFractionIsTheShareOfTheDisk) {
    TruthStage s;
    s.camera(8, 0.01);
    s.raster = {8, 8, {}, {}};
    s.scene.limb_darkening = false;
    s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, default_body(BodyId::kMoon), s.grid), {}};
    s.add(cube(lambert(0.5), s.grid), {0, 0, 5}, {});
    s.request = {};
    s.request.visibility = false;
    s.build();
    s.render_again();
    FrameTruth t = s.renderer->make_truth(s.request, 8, 8);
    t.raster = s.raster;
    const double sun_rad = std::asin(kSunRadius_m / kAstronomicalUnit_m);
    const double moon_m = 1.25e7,
                 moon_rad = std::asin(kFigures[index_of(BodyId::kMoon)].equatorial_radius_m / moon_m);
    double squares = 0;
    int count = 0;
    for (int turn = 0; turn < 24; ++turn)
        for (const double off : {-0.9, -0.6, -0.3, 0.0, 0.3, 0.6, 0.9}) {
            const double phi = turn * kPi / 12, away_rad = moon_rad + off * sun_rad;
            s.world.bodies[BodyId::kMoon].world_m =
                moon_m * Vec3d{std::sin(away_rad) * std::cos(phi), std::sin(away_rad) * std::sin(phi),
                               -std::cos(away_rad)};
            s.render_again();
            s.renderer->report_truth(t);
            const double curve = std::tan(moon_rad) / sun_rad;
            const double error = t.things[0].sunlit - left_of_disk(curve + off, curve);
            EXPECT_NEAR(error, 0, 0.014) << turn << " " << off;
            squares += error * error, ++count;
        }
    EXPECT_LT(std::sqrt(squares / count), 0.005);
}

TEST(Truth, TheSunsDiskIsInTheLayer) {
    TruthStage s;
    s.camera(128, 0.005);  // the disk's radius is 0.00465
    s.sun({0, 0, 1});
    const FrameTruth t = s.tell();
    EXPECT_EQ(value_at(t.layers.object, 64, 64), kSunId);
    EXPECT_EQ(value_at(t.layers.object, 1, 1), kSkyId);
    const double radius_px = 64 / 0.005 * std::tan(std::asin(kSunRadius_m / kAstronomicalUnit_m));
    // Pixels of a disk of 60 px: the lattice's own error is far below its circumference.
    EXPECT_NEAR(static_cast<double>(t.things[0].visible_px), kPi * radius_px * radius_px, 2 * radius_px);
}

}  // namespace
}  // namespace hilcam
