#include "render/frame/image_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// The world a time later, the camera turning and moving as given; the objects stay.
WorldSnapshot later(const WorldSnapshot& world, double seconds, Vec3d velocity_m_s, Vec3d rate_rad_s) {
    WorldSnapshot out = world;
    const std::int64_t ns = std::llround(seconds * 1e9);
    out.time = world.time + ns;
    out.camera = propagate({world.time, world.camera, velocity_m_s, rate_rad_s}, out.time);
    return out;
}

class MotionStage : public Stage {
  public:
    MotionStage() {
        camera(64, 0.5);
        quality.max_depth = 1;
        quality.samples_per_axis = 8;
    }
    // Of the middle of the light, rendered at both ends.
    Vec2d rendered_way_px(const WorldSnapshot& before, const WorldSnapshot& after) {
        world = before;
        render_again();
        const Vec2d from = light().centroid_px;
        world = after;
        render_again();
        const Vec2d to = light().centroid_px;
        return {to.x - from.x, to.y - from.y};
    }
};

TEST(ImageMotion, IsWhatTheRenderingsAtBothEndsShow) {
    MotionStage s;
    SceneObject square = plate(lambert(1), s.grid);
    for (Vec3f& v : square.mesh.vertices_m) v = 0.4f * v;
    s.add(std::move(square), {0, 0, 4});
    s.build();
    const WorldSnapshot middle = s.world;
    // Turned about x and y and moved sideways, by a pixel or two.
    const Vec3d rate{0.021, 0.013, 0}, velocity{0.05, -0.11, 0};
    const WorldSnapshot before = later(middle, -0.5, velocity, rate),
                        after = later(middle, 0.5, velocity, rate);
    const ImageMotion motion = s.renderer->motion(middle, before, after);
    const Vec2d rendered = s.rendered_way_px(before, after);
    // A grid of 8 rays per pixel puts an edge 16 px long and straight along the rows within 1/16 px.
    EXPECT_NEAR(motion.displacement_px.x, rendered.x, 0.07);
    EXPECT_NEAR(motion.displacement_px.y, rendered.y, 0.07);
    // The formula: f (-omega_y, +omega_x) of the turn, -f v / Z of the way; 64 px over tan 0.5 each side.
    const double f = s.geometry.focal_length_px;
    EXPECT_NEAR(motion.displacement_px.x, f * (-rate.y - velocity.x / 4), 0.01);
    EXPECT_NEAR(motion.displacement_px.y, f * (rate.x - velocity.y / 4), 0.01);
}

TEST(ImageMotion, ATurnAboutTheBoresightMovesTheCornersOnly) {
    MotionStage s;
    Star star;
    star.world_dir = {0, 0, 1};
    s.scene.stars = {star};
    s.build();
    const double turn = 0.1;
    const WorldSnapshot before = later(s.world, -0.5, {}, {0, 0, turn}),
                        after = later(s.world, 0.5, {}, {0, 0, turn});
    const ImageMotion motion = s.renderer->motion(s.world, before, after);
    EXPECT_EQ(motion.displacement_px.x, 0);  // sky only
    // A chord of the corner's circle.
    EXPECT_NEAR(motion.largest_px, 32 * std::sqrt(2.0) * 2 * std::sin(turn / 2), 1e-9);
}

TEST(ImageMotion, AThingThatSpinsMovesItsOutline) {
    MotionStage s;
    s.add(plate(lambert(1), s.grid), {0, 0, 4});
    s.build();
    WorldSnapshot before = s.world, after = s.world;
    const Quat still = s.world.objects[0].world_from_body;
    before.objects[0].world_from_body = from_rotation_vector({0, 0, -0.05}) * still;
    after.objects[0].world_from_body = from_rotation_vector({0, 0, 0.05}) * still;
    const ImageMotion motion = s.renderer->motion(s.world, before, after);
    EXPECT_NEAR(motion.displacement_px.x, 0, 1e-6);
    EXPECT_NEAR(motion.displacement_px.y, 0, 1e-6);
    // The sphere about it has the plate's half diagonal as radius.
    EXPECT_NEAR(motion.largest_px, 64 * std::sqrt(2.0) / 4 * 2 * std::sin(0.05), 1e-3);
}

TEST(ImageMotion, ThePictureIsOfWhatFillsMostOfIt) {
    MotionStage s;
    s.add(plate(lambert(1), s.grid), {0, 0, 4});
    SceneObject small = plate(lambert(1), s.grid);
    for (Vec3f& v : small.mesh.vertices_m) v = 0.1f * v;
    s.add(std::move(small), {0.8, 0.8, 3});
    s.build();
    WorldSnapshot before = s.world, after = s.world;
    after.objects[1].position_world_m.x += 0.2;
    const ImageMotion motion = s.renderer->motion(s.world, before, after);
    EXPECT_EQ(motion.displacement_px.x, 0);
    EXPECT_NEAR(motion.largest_px, 64 * 0.2 / 3, 0.15);
}

TEST(ImageMotion, APointThatTheCameraFollowsDriftsAgainstTheStars) {
    MotionStage s;
    s.quality.rays_across = 64;
    SceneObject far = plate(lambert(1), s.grid);
    s.add(std::move(far), {0, 0, 200});
    s.render();
    ASSERT_FALSE(s.points.empty());
    // It moves to the right at 2 m/s, the camera turns with it: 0.01 rad/s about +y.
    WorldSnapshot before = later(s.world, -0.5, {}, {0, 0.01, 0}),
                  after = later(s.world, 0.5, {}, {0, 0.01, 0});
    before.objects[0].position_world_m.x -= 1;
    after.objects[0].position_world_m.x += 1;
    s.renderer->set_drifts(before, after, 1, s.points);
    for (const PointSource& point : s.points) {
        EXPECT_EQ(point.object, 0u);
        // The stars go left at f times 0.01; it stays.
        EXPECT_NEAR(point.drift_px_s.x, 64 * 0.01, 1e-3);
        EXPECT_NEAR(point.drift_px_s.y, 0, 1e-6);
    }
}

TEST(ImageMotion, ABodyOfAFewPixelsThatTheCameraFollowsDriftsAgainstTheStars) {
    MotionStage s;
    s.scene.body(BodyId::kMoon) = {true, BodyLook(BodyId::kMoon, default_body(BodyId::kMoon), s.grid), {}};
    s.world.bodies[BodyId::kMoon].world_m = {0, 0, 4e7};
    s.render();
    ASSERT_GT(s.points.size(), 1u);
    WorldSnapshot before = later(s.world, -0.5, {}, {0, 0.01, 0}),
                  after = later(s.world, 0.5, {}, {0, 0.01, 0});
    before.bodies[BodyId::kMoon].world_m.x -= 2e5;
    after.bodies[BodyId::kMoon].world_m.x += 2e5;
    s.renderer->set_drifts(before, after, 1, s.points);
    for (const PointSource& point : s.points)
        EXPECT_NEAR(point.drift_px_s.x, s.geometry.focal_length_px * 0.01, 1e-3);
}

Star star_at(Vec3d dir) {
    Star star;
    star.world_dir = normalized(dir);
    star.irradiance_w_m2_um.bin.fill(1);
    return star;
}

TEST(Points, ARollingShutterShowsAStarWhereItsRowSeesIt) {
    MotionStage s;
    const double line_s = 1e-3, f = 64;
    s.models.rays = {"rolling", line_s};
    // Down the field, 20 px below and 10 px right of the middle at the frame's time.
    s.scene.stars = {star_at({10 / f, 20 / f, 1})};
    s.world.camera_rate_rad_s = {-2, 1.5, 0};
    s.render();
    ASSERT_EQ(s.points.size(), 1u);
    const double y = s.points[0].position_px.y, x = s.points[0].position_px.x;
    // Turned back by the camera's own turn until that row's instant, the star is on that row.
    const double t = (y - 32) * line_s;
    const Vec3d d = transposed(to_matrix(from_rotation_vector(t * s.world.camera_rate_rad_s))) *
                    s.scene.stars[0].world_dir;
    EXPECT_NEAR(32 + f * d.y / d.z, y, 1e-3);
    EXPECT_NEAR(32 + f * d.x / d.z, x, 1e-3);
    // By hand: it moves up by 64 px times 2 rad/s (1 + 0.31^2) in 20 ms: 2.4 px or so, not a fraction.
    EXPECT_NEAR(y, 52 - 2.4, 0.3);
    EXPECT_EQ(s.points[0].irradiance_w_m2_um[0], 1);
}

TEST(Points, ARollingShutterAtRestShowsStarsInPlace) {
    MotionStage s;
    s.models.rays = {"rolling", 1e-3};
    s.scene.stars = {star_at({0.1, 0.2, 1})};
    s.render();
    ASSERT_EQ(s.points.size(), 1u);
    EXPECT_NEAR(s.points[0].position_px.x, 32 + 6.4, 1e-5);
    EXPECT_NEAR(s.points[0].position_px.y, 32 + 12.8, 1e-5);
}

// A line that looks ever farther down (+y): rows of the ground go up over the sensor.
constexpr double kLine_s = 1e-3;
Vec3d scan_rate(double rows_per_row) { return {-rows_per_row / (64 * kLine_s), 0, 0}; }

TEST(Points, AScanningLineSeesAStarOnce) {
    for (const double speed : {1.0, 2.5}) {
        MotionStage s;
        s.models.rays = {"pushbroom", kLine_s};
        const double angle = 0.25;  // below the boresight at the frame's time
        s.scene.stars = {star_at({0, std::sin(angle), std::cos(angle)})};
        s.world.camera_rate_rad_s = scan_rate(speed);
        s.render();
        ASSERT_EQ(s.points.size(), 1u) << speed;
        // It is on the line when the camera has turned by that angle.
        EXPECT_NEAR(s.points[0].position_px.y, 32 + angle / (speed / 64), 1e-3) << speed;
        EXPECT_NEAR(s.points[0].position_px.x, 32, 1e-3);
        // At speed 1 a line's time of light, at 2.5 it passes a row of pixels in less.
        EXPECT_NEAR(s.points[0].irradiance_w_m2_um[0], 1 / speed, 1e-4);
    }
}

TEST(Points, ASlowLineDrawsAStarLongerWithMoreLight) {
    MotionStage s;
    s.models.rays = {"pushbroom", kLine_s};
    s.scene.stars = {star_at({0, 0, 1})};
    for (int i = 0; i < 40; ++i) s.scene.stars.push_back(star_at({0, -1, 0.1}));  // room, out of sight
    s.world.camera_rate_rad_s = scan_rate(0.125);
    s.render();
    double sum = 0, middle = 0, spread = 0;
    for (const PointSource& p : s.points) {
        sum += p.irradiance_w_m2_um[0];
        middle += p.irradiance_w_m2_um[0] * p.position_px.y;
        spread += p.irradiance_w_m2_um[0] * (p.position_px.y - 32) * (p.position_px.y - 32);
    }
    EXPECT_EQ(s.points.size(), 8u);
    EXPECT_NEAR(sum, 8, 1e-3);
    EXPECT_NEAR(middle / sum, 32, 1e-3);
    // Eight points over seven rows, at the middles of eight parts: 7^2 / 12 (1 - 1/64); with the pixel's own
    // row they make the eight rows for which the star is on the line.
    EXPECT_NEAR(spread / sum, 49.0 / 12 * (1 - 1.0 / 64), 1e-2);
}

TEST(Points, AScanningLineGivesAPointTheLightOfAPatchOfTheSameIrradiance) {
    // Squares, of which the one of 8 px is traced and the one of 4 px is points, swept at three quarters of a
    // row per row.
    for (const double side_px : {8.0, 4.0}) {
        MotionStage s;
        s.models.rays = {"pushbroom", kLine_s};
        SceneObject square = plate(lambert(1), s.grid);
        for (Vec3f& v : square.mesh.vertices_m) v = static_cast<float>(side_px / 2 / 64 * 50) * v;
        s.add(std::move(square), {0, 0, 50});
        s.quality.samples_per_axis = 16;
        s.world.camera_rate_rad_s = scan_rate(0.75);
        s.render();
        EXPECT_EQ(s.points.empty(), side_px > 5) << side_px;
        // Radiance E_s / pi over its solid angle; the line sees it for a time that is 1 / 0.75 of a stare's.
        // 16 rays along a pixel, 96 along the little picture: 1 % of the square's sides.
        const double irradiance = kSun_w_m2_um / kPi * side_px * side_px / (64 * 64);
        EXPECT_NEAR(s.light().irradiance / irradiance, 1 / 0.75, 0.02) << side_px;
        EXPECT_NEAR(s.light().centroid_px.x, 32, 0.05) << side_px;
        EXPECT_NEAR(s.light().centroid_px.y, 32, 0.05) << side_px;
    }
}

}  // namespace
}  // namespace hilcam
