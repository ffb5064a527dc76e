#include "emulator/characterise/camera_bench.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The plate is one metre in front of the camera, as large as the field of view requires.
constexpr double kDistance_m = 1;

MaterialConfig lambert(double albedo) {
    MaterialConfig material;
    material.reflectance = Curve::constant(albedo);
    return material;
}

// Returns half the side of the square about the boresight that all pixels see, including the guard band [m].
double half_side_m(const ImageGeometry& g) {
    double most = 0;
    for (int y = -g.guard_px; y <= g.height_px + g.guard_px; ++y)
        for (const double x : {-1.0 * g.guard_px, 1.0 * g.width_px + g.guard_px}) {
            const Vec3d d = g.direction_camera(x, y);
            most = std::max({most, std::abs(d.x), std::abs(d.y)});
        }
    for (int x = -g.guard_px; x <= g.width_px + g.guard_px; ++x)
        for (const double y : {-1.0 * g.guard_px, 1.0 * g.height_px + g.guard_px}) {
            const Vec3d d = g.direction_camera(x, y);
            most = std::max({most, std::abs(d.x), std::abs(d.y)});
        }
    return 2 * most * kDistance_m;
}

// Two rectangles in the plane z = kDistance_m that share the edge, facing the camera.
SceneObject plates(const BenchTarget& target, const ImageGeometry& g, const SpectralGrid& grid) {
    const Vec3d middle = kDistance_m * g.direction_camera(0.5 * g.width_px, 0.5 * g.height_px);
    // Large enough for every position of the edge.
    const double reach = 2 * half_side_m(g);
    const Vec3d along{std::sin(target.edge_tilt_rad), std::cos(target.edge_tilt_rad), 0};
    const Vec3d across{along.y, -along.x, 0};
    SceneObject object;
    for (const double side : {-1.0, 0.0, 1.0})
        for (const double end : {-1.0, 1.0})
            object.mesh.vertices_m.push_back(to_float(middle + reach * (side * across + end * along)));
    object.mesh.triangles = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    object.mesh.surface_of_triangle = {0, 0, 1, 1};
    object.mesh.surfaces.resize(2);
    object.materials = {make_material(lambert(target.bright_albedo), grid),
                        make_material(lambert(target.dark_albedo), grid)};
    return object;
}

// A world with only the lamp; bodies are far away.
WorldSnapshot empty_room() {
    WorldSnapshot world;
    for (std::size_t i = 0; i < kBodyCount; ++i) world.bodies[static_cast<BodyId>(i)].world_m = {1e15, 0, 0};
    world.bodies.sun_world_m = {0, 0, -kAstronomicalUnit_m};
    world.objects.resize(1);
    return world;
}

}  // namespace

CameraBench::CameraBench(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                         double lamp_w_m2_um, const DetectorPictures& pictures, std::uint64_t seed)
    : camera_(camera),
      grid_(grid),
      sampling_(sampling),
      lamp_w_m2_um_(lamp_w_m2_um),
      geometry_(geometry_of(camera, sampling.guard_px)),
      image_(geometry_of(camera, sampling.guard_px, sampling.oversampling)),
      chain_(camera, grid, sampling, pictures),
      seed_(seed),
      full_(image_.padded_width(), image_.padded_height(), grid.size()),
      dimmed_(image_.padded_width(), image_.padded_height(), grid.size()),
      mean_e_(array_size(camera)[0], array_size(camera)[1]) {
    for (DnImage& frame : frame_) frame = DnImage(frame_size(camera)[0], frame_size(camera)[1]);
}

void CameraBench::show(const BenchTarget& target) {
    Scene scene;
    scene.objects.push_back(plates(target, image_, grid_));
    for (int b = 0; b < grid_.size(); ++b)
        scene.sun_irradiance_1au_w_m2_um[b] = static_cast<float>(lamp_w_m2_um_);
    RenderQuality quality;
    quality.path_model = "direct";
    quality.max_depth = 1;
    quality.samples_per_axis = sampling_.samples_per_axis;
    Renderer renderer(std::move(scene), grid_, image_, quality);
    std::vector<PointSource> points;
    points.reserve(renderer.max_points());
    RenderStats stats;
    renderer.render(empty_room(), {seed_, 0}, full_, points, stats);
    filter_ = -1;
}

void CameraBench::expose(const Exposure& exposure, double filter) {
    if (filter != filter_) {
        std::transform(full_.all().begin(), full_.all().end(), dimmed_.all().begin(),
                       [&](float value) { return static_cast<float>(filter) * value; });
        filter_ = filter;
    }
    exposure_ = exposure;
    chain_.expose(dimmed_, {}, exposure, mean_e_);
}

const DnImage& CameraBench::frame() { return frame(frames_ + 1); }

const DnImage& CameraBench::frame(std::uint64_t number) {
    frames_ = number;
    DnImage& next = frame_[number % 2];
    chain_.digitise(mean_e_, exposure_, {seed_, number}, next);
    return next;
}

}  // namespace hilcam
