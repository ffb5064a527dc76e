// How far away: 0.1 m to 10 au.

#include <limits>

#include "render/frame/plan.h"
#include "render/scene/embree_scene.h"
#include "tests/extremes/convex_truth.h"
#include "tests/extremes/groups.h"

namespace hilcam::extremes {
namespace {

constexpr const char* kCubeTruth =
    "each lit face of a Lambertian cube is a polygon of radiance albedo E cos(i) / pi; its corners by the "
    "pinhole's equation, its area and centroid by the shoelace formula, in double precision.";
constexpr const char* kCubeLimit =
    "4.5 standard deviations of what a grid of rays can know of the faces' edges (step^(3/2) sqrt(length / "
    "12) of "
    "area each), and the grain of single precision.";

std::string metres(double distance_m) {
    return distance_m < kAstronomicalUnit_m ? text(distance_m) + " m"
                                            : text(distance_m / kAstronomicalUnit_m) + " au";
}

// A cube in sunlight that is not along its axes; nothing is behind it.
Case cube_case(std::string value, const std::function<Stage()>& stage_of, double size_m) {
    const double radius_m = std::sqrt(0.75) * size_m;
    const Stage s = stage_of();
    return {std::move(value), limits_of(s, cube_truth(s, size_m, 0.8), radius_m), [stage_of, size_m] {
                Stage stage = stage_of();
                stage.quality.path_model = "direct";
                stage.render();
                return compared(stage, cube_truth(stage, size_m, 0.8));
            }};
}
// A hundred au from the object, with the light of one: behind the camera wherever that is.
void put_sun(Stage& s) {
    constexpr double kSun_au = 100;
    s.world.bodies.sun_world_m = s.world.objects[0].position_world_m +
                                 kSun_au * kAstronomicalUnit_m * normalized(Vec3d{0.5, -0.4, -1});
    for (int b = 0; b < 2; ++b)
        s.scene.sun_irradiance_1au_w_m2_um[b] *= static_cast<float>(kSun_au * kSun_au);
}

}  // namespace

// From hundreds of pixels over a cloud of points to a millionth of a pixel.
Group distance_one_lens() {
    Group group{"DistanceThroughOneLens",
                "Distance: a cube of 1 m through one lens",
                "distance; 1 mrad a pixel",
                {"irradiance [W m^-2 um^-1]", "centroid, x [px]"},
                kCubeTruth,
                kCubeLimit,
                {}};
    for (const double distance_m : {3.0, 10.0, 30.0, 100.0, 120.0, 150.0, 300.0, 900.0, 1100.0, 1e4, 1e6, 4e7,
                                    1e9, kAstronomicalUnit_m, 10 * kAstronomicalUnit_m})
        group.cases.push_back(cube_case(
            metres(distance_m),
            [distance_m] {
                Stage s;
                s.camera(1024, 0.512);
                s.quality.rays_across = 512;
                s.quality.point_samples = 256;
                s.add(cube(lambert(0.8), s.grid), {0.0113 * distance_m, -0.0071 * distance_m, distance_m},
                      {0.4, 0.7, 0.2});
                put_sun(s);
                return s;
            },
            1));
    return group;
}

Group distance_long_lens() {
    Group group{"DistanceThroughLongerLenses",
                "Distance: a cube of 1 m, always 100 px wide",
                "distance; pixels of 10 mm there",
                {"irradiance [W m^-2 um^-1]", "centroid, x [px]"},
                kCubeTruth,
                std::string(kCubeLimit) +
                    " From 1 au on a pixel is a few times the grain of double "
                    "precision's directions.",
                {}};
    for (const double distance_m :
         {2.0, 10.0, 1e3, 1e5, 1e7, 1e9, kAstronomicalUnit_m, 10 * kAstronomicalUnit_m})
        group.cases.push_back(cube_case(
            metres(distance_m),
            [distance_m] {
                Stage s;
                s.camera(256, 1);
                s.geometry.focal_length_px = 100 * distance_m;
                s.quality.samples_per_axis = 4;
                s.add(cube(lambert(0.8), s.grid), {0, 0, distance_m}, {0.4, 0.7, 0.2});
                put_sun(s);
                return s;
            },
            1));
    return group;
}

// 1.5e12 m has a grain of 0.2 mm in double precision: truth is worked out from the places that the renderer
// gets.
Group distance_of_origin() {
    Group group{"DistanceOfTheOrigin",
                "Distance: camera and a cube of 1 m far from the world's origin",
                "distance of the camera from the origin; 5 m to the cube",
                {"irradiance [W m^-2 um^-1]", "centroid, x [px]"},
                kCubeTruth,
                kCubeLimit,
                {}};
    for (const double distance_m : {0.0, 4.2e7, 1e9, kAstronomicalUnit_m, 10 * kAstronomicalUnit_m})
        group.cases.push_back(cube_case(
            metres(distance_m),
            [distance_m] {
                const Vec3d there = distance_m * normalized(Vec3d{0.3, -0.8, 0.5});
                Stage s;
                s.camera(256, 0.2);
                s.quality.samples_per_axis = 4;
                s.add(cube(lambert(0.8), s.grid), there + Vec3d{0, 0, 5}, {0.4, 0.7, 0.2});
                s.world.camera.position_world_m = there;
                put_sun(s);
                return s;
            },
            1));
    return group;
}

// A ray to a point 0.3 of the way up a face of a 1 m cube, in the ray space that the plan chooses
// (frame_context.h).
Group distance_of_rays() {
    Group group{
        "DistanceOfRays",
        "Distance: where a ray meets a cube of 1 m",
        "distance",
        {"distance [m]"},
        "the face's plane in double precision; the error is how far the point that was met is from it.",
        "8 roundings to single precision of the way along the ray: of all of it where rays begin at the "
        "camera, of 2 m where they begin at the object, 20 of its radii away; and 4 to double precision.",
        {}};
    constexpr double kRadius_m = 0.8660254037844386;
    for (double distance_m = 1; distance_m < 3e12; distance_m *= 10) {
        WorldSnapshot world;
        world.objects = {{{0, 0, distance_m + 0.5}, from_rotation_vector({0, 0.2, 0})}};
        const RaySpace space = choose_ray_space(world, std::span(&kRadius_m, 1), true);
        const bool far = space.start_before_m > 0;
        const double way_m = far ? 2 * space.start_before_m : distance_m;
        group.cases.push_back(
            {metres(distance_m),
             {8 * kFloatGrain * way_m + 4 * kDoubleGrain * distance_m},
             [world, space, far] {
                 const SpectralGrid grid({0.5, 0.6});
                 const SceneObject object = cube(lambert(0.5), grid);
                 const std::vector<std::vector<const Mesh*>> meshes = {{&object.mesh}};
                 EmbreeScene scene(meshes, true);
                 const std::size_t level = 0;
                 const Pose& pose = world.objects[0];
                 const Mat3d m = to_matrix(pose.world_from_body);
                 const Vec3d target = pose.position_world_m + m * Vec3d{0.1, 0.3, -0.5};
                 const Vec3d dir = normalized(target), normal = m * Vec3d{0, 0, -1};
                 const double start_m = far ? length(target) - space.start_before_m : 0;
                 scene.place(world.objects, std::span(&level, 1), space.origin_world_m);
                 RayPacket ray;
                 HitPacket hit;
                 ray.count = 1;
                 const Vec3f from = to_float(start_m * dir - space.origin_world_m), along = to_float(dir);
                 ray.set(0, from, along, 0, std::numeric_limits<float>::infinity());
                 scene.intersect(ray, Coherence::kIncoherent, hit);
                 const bool met = hit.object[0] != HitPacket::kMiss;
                 const Vec3d beside = to_double(from) +
                                      static_cast<double>(hit.distance[0]) * to_double(along) -
                                      (target - space.origin_world_m);
                 return std::vector<Found>{{length(target), met ? std::abs(dot(beside, normal)) : NAN}};
             }});
    }
    return group;
}

}  // namespace hilcam::extremes
