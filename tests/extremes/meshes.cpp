// Meshes as they should not be.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "io/meshes/mesh_file.h"
#include "render/vocabulary/check.h"
#include "tests/extremes/convex_truth.h"
#include "tests/extremes/groups.h"
#include "tests/support/split_triangles.h"

namespace hilcam::extremes {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();
constexpr double kRadius_m = 0.8660254037844386;

Stage stage_for_meshes() {
    Stage s;
    s.camera(256, 0.2);
    s.quality.path_model = "direct";
    s.quality.samples_per_axis = 4;
    s.sun({0.5, -0.4, -1});
    return s;
}
Stage stage_with(SceneObject object) {
    Stage s = stage_for_meshes();
    s.add(std::move(object), {0, 0, 5}, {0.4, 0.7, 0.2});
    return s;
}
SceneObject plain_cube() { return cube(lambert(0.8), SpectralGrid({0.5, 0.6, 0.7})); }
void finish(Mesh& mesh) { mesh.surface_of_triangle.resize(mesh.triangles.size()); }

// --- what is done to a cube

void duplicate(Mesh& mesh) {
    const auto once = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
}
void invert(Mesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
}
void duplicate_inverted(Mesh& mesh) {
    for (auto triangle : std::vector(mesh.triangles)) {
        std::swap(triangle[0], triangle[1]);
        mesh.triangles.push_back(triangle);
    }
}
// A corner twice, one three times, corners on a line, a needle along an edge.
void add_degenerate(Mesh& mesh) {
    mesh.vertices_m.push_back({0, -0.5f, -0.5f});
    mesh.vertices_m.push_back({0, std::nextafter(-0.5f, 0.0f), -0.5f});
    for (const std::array<std::uint32_t, 3> triangle :
         {std::array<std::uint32_t, 3>{0, 0, 1}, {2, 2, 2}, {0, 8, 1}, {0, 1, 9}})
        mesh.triangles.push_back(triangle);
}
// Walls through the inside: edges of three and four triangles.
void add_inner_walls(Mesh& mesh) {
    for (const std::array<std::uint32_t, 3> triangle :
         {std::array<std::uint32_t, 3>{0, 3, 7}, {0, 7, 4}, {1, 2, 6}, {1, 6, 5}})
        mesh.triangles.push_back(triangle);
}
// A triangle of its own with this corner.
void add_corner(Mesh& mesh, Vec3f corner) {
    mesh.vertices_m.push_back(corner);
    mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.vertices_m.size() - 1)});
}
// Dust on a face: a thousand triangles of 1e-7 m.
void add_dust(Mesh& mesh) {
    for (int i = 0; i < 1000; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
        const float x = -0.4f + 8e-4f * static_cast<float>(i);
        for (const Vec3f v : {Vec3f{x, 0, -0.5f}, {x + 1e-7f, 0, -0.5f}, {x, 1e-7f, -0.5f}})
            mesh.vertices_m.push_back(v);
        mesh.triangles.push_back({first, first + 2, first + 1});
    }
}

Case cube_with(const std::string& what, const std::function<void(Mesh&)>& change) {
    const Stage s = stage_with(plain_cube());
    return {what, limits_of(s, cube_truth(s, 1, 0.8), kRadius_m), [change] {
                SceneObject object = plain_cube();
                change(object.mesh);
                finish(object.mesh);
                Stage stage = stage_with(std::move(object));
                const ConvexTruth truth = cube_truth(stage, 1, 0.8);
                stage.render();
                return compared(stage, truth);
            }};
}

}  // namespace

Group meshes() {
    Group group{"Meshes",
                "Meshes: a cube of 1 m, and what may be wrong with it",
                "mesh",
                {"irradiance [W m^-2 um^-1]", "centroid, x [px]"},
                "the cube as it should be, in closed form; of one triangle the triangle.",
                "as of the cube of 1 m, 4 x 4 rays a pixel.",
                {}};
    group.cases = {cube_with("as it should be", [](Mesh&) {}),
                   cube_with("every triangle twice", duplicate),
                   cube_with("every triangle inverted", invert),
                   cube_with("every triangle twice, once inverted", duplicate_inverted),
                   cube_with("with triangles of no area", add_degenerate),
                   cube_with("not manifold: walls inside", add_inner_walls),
                   cube_with("49,152 triangles", [](Mesh& mesh) { split_triangles(mesh, 6); }),
                   cube_with("with triangles of 1e-7 m on a face", add_dust),
                   cube_with("with a triangle to a vertex that is no number",
                             [](Mesh& m) {
                                 add_corner(m, {kNan, 0, 0});
                             }),
                   cube_with("with a triangle to a vertex at infinity", [](Mesh& m) {
                       add_corner(m, {0, 0, kInfinity});
                   })};

    // Black, a hundred thousand kilometres wide, behind the cube.
    const Stage s = stage_with(plain_cube());
    group.cases.push_back(
        {"before two triangles of 1e8 m", limits_of(s, cube_truth(s, 1, 0.8), kRadius_m), [] {
             Stage stage = stage_with(plain_cube());
             SceneObject wall = plate(lambert(0), stage.grid);
             for (Vec3f& v : wall.mesh.vertices_m) v = 1e8f * v;
             stage.add(std::move(wall), {0, 0, 10});
             stage.render();
             return compared(stage, cube_truth(stage, 1, 0.8));
         }});

    static constexpr std::array<Vec3d, 3> kCorners = {
        {{-0.5, -0.5, 0.25}, {0.5, -0.375, 0.5}, {0.125, 0.5, 0}}};
    const auto one = [] {
        return stage_with(object_of({to_float(kCorners[0]), to_float(kCorners[1]), to_float(kCorners[2])},
                                    {{0, 1, 2}}, lambert(0.8), SpectralGrid({0.5, 0.6, 0.7})));
    };
    const double radius_m = length(kCorners[1]);
    const Stage triangle = one();
    group.cases.push_back(
        {"one triangle", limits_of(triangle, triangle_truth(triangle, kCorners, 0.8), radius_m), [one] {
             Stage stage = one();
             const ConvexTruth truth = triangle_truth(stage, kCorners, 0.8);
             stage.render();
             return compared(stage, truth);
         }});
    group.cases.push_back(
        {"no triangle", {0, 0}, [] {
             Stage stage = stage_with(object_of({}, {}, lambert(0.8), SpectralGrid({0.5, 0.6, 0.7})));
             stage.render();
             double light = static_cast<double>(stage.points.size());
             for (const float value : stage.radiance.all()) light += std::abs(value);
             return std::vector<Found>{{0, light}, {0, 0}};
         }});
    return group;
}

// The loader keeps out what no picture can come of.
Group mesh_files() {
    Group group{"MeshFiles",
                "Meshes: files that are refused",
                "file",
                {"meshes that come of it"},
                "none: the loader's message names the file.",
                "0.",
                {}};
    const auto refuse = [&](const std::string& what, const std::string& name, const std::string& text) {
        group.cases.push_back({what, {0}, [name, text] {
                                   const std::filesystem::path folder =
                                       std::filesystem::temp_directory_path() /
                                       ("hilcam_extremes_" + std::to_string(getpid()));
                                   std::filesystem::create_directories(folder);
                                   std::ofstream(folder / name) << text;
                                   double accepted = 1;
                                   try {
                                       load_mesh(folder / name);
                                   } catch (const InputError& error) {
                                       if (std::string(error.what()).find(name) != std::string::npos)
                                           accepted = 0;
                                   }
                                   std::filesystem::remove_all(folder);
                                   return std::vector<Found>{{0, accepted}};
                               }});
    };
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    refuse("a vertex that is no number", "nan.ply", head + "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    refuse("a vertex at infinity", "inf.ply", head + "inf 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    refuse("a vertex beyond single precision", "far.ply", head + "1e39 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    refuse("a corner that does not exist", "corner.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    refuse("no triangle", "none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    refuse("only triangles of no area", "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 2 2 2\n");
    refuse("nothing", "empty.stl", "");
    return group;
}

// All of it at once, with a camera inside a box: every path ends, and ends in a number.
Group mesh_models() {
    Group group{"MeshModels",
                "Meshes: every path model in a broken room",
                "path model, depth",
                {"pixels that are not finite or negative"},
                "none.",
                "0.",
                {}};
    for (const auto& [model, depth] : {std::pair{"direct", 1}, {"path", 16}, {"path", 64}})
        group.cases.push_back(
            {std::string(model) + ", " + std::to_string(depth), {0}, [model = model, depth = depth] {
                 Stage s;
                 s.quality.path_model = model;
                 s.quality.max_depth = depth;
                 s.camera(16, 0.5);
                 s.add(
                     object_of({{-5, -5, 2},
                                {5, -5, 2},
                                {0, 5, 2},
                                {0, 0, 1},
                                {0, 1e-20f, 1},
                                {3, 0, 1.5f},
                                {1, 1, 1},
                                {kNan, 0, 3}},
                               {{0, 1, 2}, {0, 1, 2}, {2, 1, 0}, {3, 4, 5}, {3, 3, 5}, {6, 6, 6}, {0, 1, 7}},
                               lambert(0.5), s.grid),
                     {0, 0, 0}, {});
                 s.add(cube(lambert(0.9), s.grid, 30), {0, 0, 0}, {0.1, 0.2, 0.3});
                 s.render();
                 double wrong = 0;
                 for (const float value : s.radiance.all())
                     wrong += std::isfinite(value) && value >= 0 ? 0 : 1;
                 return std::vector<Found>{{0, wrong}};
             }});
    return group;
}

}  // namespace hilcam::extremes
