// The same thing far and near, large and small: flux within 0.5 %, centroid within 0.01 pixel, nothing that
// is not finite.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "render/embree_scene.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

struct Truth {
    double irradiance = 0;
    Vec2d centroid_px;
};

// Of a convex, sunlit, white cube: each lit face that is seen is a polygon of even radiance in the image.
Truth cube_truth(const Stage& s, double size_m, double albedo) {
    Truth out;
    const Pose& object = s.world.objects[0];
    const Mat3d m = to_matrix(object.world_from_body);
    const Mat3d camera_from_world = transposed(to_matrix(s.world.camera.world_from_body));
    const Vec3d sun = normalized(s.world.bodies.sun_world_m - object.position_world_m);
    const Vec3d offset = object.position_world_m - s.world.camera.position_world_m;
    const std::array<Vec3d, 3> axes = {transposed(m).x, transposed(m).y, transposed(m).z};
    for (std::size_t k = 0; k < 3; ++k)
        for (const double sign : {-1.0, 1.0}) {
            const Vec3d n = sign * axes[k], u = axes[(k + 1) % 3], v = axes[(k + 2) % 3];
            const Vec3d middle = offset + 0.5 * size_m * n;
            if (dot(n, middle) >= 0 || dot(n, sun) <= 0) continue;
            const double radiance = albedo * kSun_w_m2_um * dot(n, sun) / kPi;
            std::array<Vec2d, 4> p;
            const std::array<Vec2d, 4> corners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
            for (std::size_t i = 0; i < 4; ++i)
                p[i] = s.geometry.project_px(camera_from_world *
                                             (middle + 0.5 * size_m * (corners[i].x * u + corners[i].y * v)));
            // Shoelace formula about the first corner, which keeps its digits where the polygon is tiny.
            double area = 0, x = 0, y = 0;
            for (std::size_t i = 1; i + 1 < 4; ++i) {
                const double ax = p[i].x - p[0].x, ay = p[i].y - p[0].y, bx = p[i + 1].x - p[0].x,
                             by = p[i + 1].y - p[0].y;
                const double part = 0.5 * (ax * by - ay * bx);
                area += part, x += part * (ax + bx) / 3, y += part * (ay + by) / 3;
            }
            const double amount =
                radiance * std::abs(area) / (s.geometry.focal_length_px * s.geometry.focal_length_px);
            out.irradiance += amount;
            out.centroid_px.x += amount * (p[0].x + x / area),
                out.centroid_px.y += amount * (p[0].y + y / area);
        }
    out.centroid_px = {out.centroid_px.x / out.irradiance, out.centroid_px.y / out.irradiance};
    return out;
}

void expect_cube(Stage& s, double size_m, const std::string& what) {
    s.quality.path_model = "direct";
    s.render();
    const Truth truth = cube_truth(s, size_m, 0.8);
    const Stage::Light seen = s.light();
    EXPECT_NEAR(seen.irradiance / truth.irradiance, 1, 0.005) << what;
    EXPECT_NEAR(seen.centroid_px.x, truth.centroid_px.x, 0.01) << what;
    EXPECT_NEAR(seen.centroid_px.y, truth.centroid_px.y, 0.01) << what;
}

// One camera, 1 mrad a pixel: from many pixels over a cloud of points to a millionth of a pixel.
TEST(Extremes, AOneMetreCubeFromNearToFortyThousandKilometres) {
    for (const double distance_m :
         {3.0, 10.0, 30.0, 100.0, 120.0, 150.0, 300.0, 900.0, 1100.0, 3e3, 1e4, 1e6, 4e7}) {
        Stage s;
        s.camera(1024, 0.512);
        s.quality.rays_across = 512;
        s.quality.point_samples = 256;
        s.sun({0.5, -0.4, -1});
        s.add(cube(lambert(0.8), s.grid), {0.0113 * distance_m, -0.0071 * distance_m, distance_m},
              {0.4, 0.7, 0.2});
        expect_cube(s, 1, std::to_string(distance_m) + " m");
    }
}

// 0.2 m before a face it fills the field, and every pixel has the face's radiance.
TEST(Extremes, ACubeSeenFromTwentyCentimetresFillsTheField) {
    Stage s;
    s.camera(64, 0.5);
    s.sun({0.3, 0, -1});
    s.quality.max_depth = 1;
    s.add(cube(lambert(0.8), s.grid), {0, 0, 0.7}, {});
    s.render();
    for (const float value : s.radiance.plane(0))
        ASSERT_NEAR(value / (0.8 * kSun_w_m2_um / std::sqrt(1.09) / kPi), 1, 1e-5);
}

// The same picture through a long lens: 100 pixels wide at every distance.
TEST(Extremes, ATargetAHundredPixelsWideKeepsItsShapeAtEveryDistance) {
    for (const double distance_m : {0.9, 10.0, 1e3, 1e5, 1e7, 4e7, 1e9}) {
        Stage s;
        s.camera(256, 1);
        s.geometry.focal_length_px = 100 * distance_m;
        s.quality.samples_per_axis = 4;
        s.sun({0.5, -0.4, -1});
        s.add(cube(lambert(0.8), s.grid, distance_m < 1 ? 0.5f : 1), {0, 0, distance_m}, {0.4, 0.7, 0.2});
        s.world.bodies.sun_world_m =
            s.world.objects[0].position_world_m + kAstronomicalUnit_m * normalized(Vec3d{0.5, -0.4, -1});
        expect_cube(s, distance_m < 1 ? 0.5 : 1, std::to_string(distance_m) + " m");
    }
}

TEST(Extremes, ATargetTenAstronomicalUnitsFromTheOrigin) {
    const Vec3d there = 10 * kAstronomicalUnit_m * normalized(Vec3d{0.3, -0.8, 0.5});
    Stage s;
    s.camera(256, 0.2);
    s.quality.samples_per_axis = 4;
    s.add(cube(lambert(0.8), s.grid), {0, 0, 5}, {0.4, 0.7, 0.2});
    s.world.camera.position_world_m = there;
    // 1.5e12 m has a grain of 0.2 mm in double precision; what the renderer gets is what truth is worked out
    // from.
    s.world.objects[0].position_world_m = there + Vec3d{0, 0, 5};
    s.world.bodies.sun_world_m = there + kAstronomicalUnit_m * normalized(Vec3d{0.5, -0.4, -1});
    expect_cube(s, 1, "10 au");
}

// No acne under a Sun at 89.99 degrees, on a coarse and a fine mesh, near and far.
TEST(Extremes, GrazingSunLeavesNoAcne) {
    for (const double distance_m : {0.2, 3.0, 1e3, 1e6}) {
        Stage s;
        s.quality.max_depth = 1;
        s.camera(64, 0.5 / distance_m);
        s.add(plate(lambert(1), s.grid), {0, 0, distance_m});
        const double grazing = 89.99 * kDegree_rad;
        s.world.bodies.sun_world_m =
            Vec3d{0, 0, distance_m} + kAstronomicalUnit_m * Vec3d{std::sin(grazing), 0, -std::cos(grazing)};
        s.render();
        for (const float value : s.radiance.plane(0))
            ASSERT_NEAR(value / (kSun_w_m2_um * std::cos(grazing) / kPi), 1, 2e-3) << distance_m;
    }
}

// One metre over the Moon: straight down, and the horizon 1.86 km away at its dip.
TEST(Extremes, ACameraOneMetreOverTheMoon) {
    const auto stage = [](Vec3d look) {
        Stage s;
        s.scene.body(BodyId::kMoon) = {true,
                                       BodyLook(
                                           BodyId::kMoon,
                                           [] {
                                               BodyConfig config;
                                               config.albedo = Curve::constant(0.2);
                                               return config;
                                           }(),
                                           s.grid),
                                       {}};
        s.world.bodies[BodyId::kMoon].world_m = {0, 0, 1737.4e3 + 1};
        s.world.camera.world_from_body = look_along(look, {1, 0, 0.1});
        s.camera(64, 0.05);
        s.quality.samples_per_axis = 4;
        s.sun({0.3, 0, -1});
        s.render();
        return s;
    };
    const Stage down = stage({0, 0, 1});
    for (const float value : down.radiance.plane(0))
        ASSERT_NEAR(value / (0.2 * kSun_w_m2_um / std::sqrt(1.09) / kPi), 1, 1e-4);
    // The horizon's dip is acos(R / (R + 1)) = 1.0729 mrad below level; the field is 100 mrad of 64 pixels.
    Stage level = stage({0, 1, 0});
    int lit = 0, dark = 0;
    for (const float value : level.radiance.plane(0)) {
        ASSERT_TRUE(std::isfinite(value));
        ++(value > 0 ? lit : dark);
    }
    const double dip_px = std::acos(1737.4e3 / (1737.4e3 + 1)) / 0.1 * 64;
    EXPECT_NEAR(lit / 64.0, 32 - dip_px, 0.6);
}

TEST(Extremes, BrokenMeshesStayFiniteAndEnd) {
    for (const char* model : {"direct", "hemisphere", "path"}) {
        Stage s;
        s.quality.path_model = model;
        s.quality.max_depth = s.quality.path_model == "hemisphere" ? 2 : 16;
        s.camera(16, 0.5);
        // A wall with its double, a needle, a triangle without area, one of three equal corners, and the
        // camera inside a box.
        s.add(object_of(
                  {{-5, -5, 2}, {5, -5, 2}, {0, 5, 2}, {0, 0, 1}, {0, 1e-20f, 1}, {3, 0, 1.5f}, {1, 1, 1}},
                  {{0, 1, 2}, {0, 1, 2}, {2, 1, 0}, {3, 4, 5}, {3, 3, 5}, {6, 6, 6}}, lambert(0.5), s.grid),
              {0, 0, 0}, {});
        s.add(cube(lambert(0.9), s.grid, 30), {0, 0, 0}, {0.1, 0.2, 0.3});
        s.render();
        for (const float value : s.radiance.all()) {
            ASSERT_TRUE(std::isfinite(value)) << model;
            ASSERT_GE(value, 0) << model;
        }
    }
}

// Where single precision parts from double: a ray to a point 0.3 of the way up a face of a 1 m cube, by
// Embree in single precision and by the plane's equation in double. From the camera the error grows as the
// distance's own grain; counted from the object (frame_view.h) it stays that of a metre.
TEST(Extremes, SinglePrecisionPartsFromDoubleWithTheDistanceUnlessRaysBeginAtTheObject) {
    const SpectralGrid grid({0.5, 0.6});
    const SceneObject object = cube(lambert(0.5), grid);
    const std::vector<std::vector<const Mesh*>> meshes = {{&object.mesh}};
    EmbreeScene scene(meshes, true);
    const std::size_t level = 0;
    printf("distance [m]  error from the camera [m]  error from the object [m]\n");
    for (double distance_m = 1; distance_m <= 4e7; distance_m *= 10) {
        const Pose pose{{0, 0, distance_m + 0.5}, from_rotation_vector({0, 0.2, 0})};
        const Mat3d m = to_matrix(pose.world_from_body);
        const Vec3d target = pose.position_world_m + m * Vec3d{0.1, 0.3, -0.5};
        const Vec3d dir = normalized(target), normal = m * Vec3d{0, 0, -1};
        const auto error_of = [&](Vec3d origin, double start) {
            scene.place(std::span(&pose, 1), std::span(&level, 1), origin);
            RayPacket ray;
            HitPacket hit;
            ray.count = 1;
            const Vec3f from = to_float(start * dir - origin), along = to_float(dir);
            ray.set(0, from, along, 0, 1e30f);
            scene.intersect(ray, Coherence::kIncoherent, hit);
            if (hit.object[0] == HitPacket::kMiss) return 1e9;
            // How far the point that was found is from the face.
            const Vec3d found =
                to_double(from) + static_cast<double>(hit.distance[0]) * to_double(along) + origin;
            return std::abs(dot(found - target, normal));
        };
        const double camera = error_of({}, 0), near = error_of(pose.position_world_m, distance_m - 1);
        printf("%12.0f  %25.2e  %25.2e\n", distance_m, camera, near);
        EXPECT_LT(near, 1e-6) << distance_m;
        if (distance_m <= 100) {
            EXPECT_LT(camera, 2e-6 * distance_m) << distance_m;
        }
    }
}

// A mesh with both of every face twice, as exporters leave them: no light is lost or doubled.
TEST(Extremes, DuplicateTrianglesCountOnce) {
    Stage s;
    SceneObject twice = cube(lambert(0.8), s.grid);
    const auto once = twice.mesh.triangles;
    for (auto triangle : once) {
        std::swap(triangle[0], triangle[1]);
        twice.mesh.triangles.push_back(triangle);
    }
    twice.mesh.surface_of_triangle.resize(twice.mesh.triangles.size());
    s.camera(256, 0.2);
    s.quality.samples_per_axis = 4;
    s.sun({0.5, -0.4, -1});
    s.add(std::move(twice), {0, 0, 5}, {0.4, 0.7, 0.2});
    expect_cube(s, 1, "doubled");
}

}  // namespace
}  // namespace hilcam
