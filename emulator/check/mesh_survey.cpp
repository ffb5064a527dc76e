#include "emulator/check/mesh_survey.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/lod/joined_sets.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Longer than any spacecraft [m], but not than a file in millimetres, or an asteroid.
constexpr double kLongestSide_m = 500;
// Height over longest side below which a triangle's corners count as collinear, by the error of single
// precision.
constexpr double kSliver = 1e-6;

// Assigns each vertex the number of its position, and returns the number of positions.
std::uint64_t number_places(const std::vector<Vec3f>& vertices_m, std::vector<std::uint32_t>& place_of) {
    std::vector<std::uint32_t> order(vertices_m.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](std::uint32_t i, std::uint32_t k) {
        const Vec3f a = vertices_m[i], b = vertices_m[k];
        if (a.x != b.x) return a.x < b.x;
        return a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    tbb::parallel_sort(order.begin(), order.end(), before);
    place_of.resize(vertices_m.size());
    std::uint32_t places = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && before(order[i - 1], order[i])) ++places;
        place_of[order[i]] = places;
    }
    return order.empty() ? 0 : places + 1u;
}

using Corners = std::array<std::uint32_t, 3>;

// Returns an edge as its two positions, the smaller first, with the direction in which a triangle uses it in
// the last bit.
std::uint64_t edge_of(std::uint32_t from, std::uint32_t to) {
    const std::uint64_t low = std::min(from, to), high = std::max(from, to);
    return low << 32 | high << 1 | (from < to ? 1u : 0u);
}

struct Topology {
    std::vector<Corners> corners;     // by places
    std::vector<std::uint8_t> whole;  // by shell: no open or inconsistent edges
};

void survey_edges(const Topology& mesh, JoinedSets& shells, std::vector<std::uint8_t>& whole,
                  MeshSurvey& out) {
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * mesh.corners.size());
    for (const Corners& t : mesh.corners)
        for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_of(t[k], t[(k + 1) % 3]));
    tbb::parallel_sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i, forward = 0;
        for (; end < edges.size() && edges[end] >> 1 == edges[i] >> 1; ++end) forward += edges[end] & 1;
        const std::size_t count = end - i;
        const bool open = count == 1, inconsistent = count == 2 && forward != 1;
        out.open_edges += open, out.inconsistent_edges += inconsistent, out.crowded_edges += count > 2;
        if (open || inconsistent || count > 2)
            whole[shells.of(static_cast<std::uint32_t>(edges[i] >> 32))] = 0;
        i = end;
    }
}

void survey_repeats(std::vector<Corners> corners, MeshSurvey& out) {
    for (Corners& t : corners) std::sort(t.begin(), t.end());
    tbb::parallel_sort(corners.begin(), corners.end());
    for (std::size_t i = 1; i < corners.size(); ++i) out.repeated_triangles += corners[i] == corners[i - 1];
}

void survey_topology(const Mesh& mesh, MeshSurvey& out) {
    std::vector<std::uint32_t> place_of;
    out.places = number_places(mesh.vertices_m, place_of);
    JoinedSets shells(out.places);
    Topology topology;
    for (const auto& t : mesh.triangles) {
        topology.corners.push_back({place_of[t[0]], place_of[t[1]], place_of[t[2]]});
        shells.join(place_of[t[0]], place_of[t[1]]);
        shells.join(place_of[t[1]], place_of[t[2]]);
    }
    std::vector<std::uint8_t> whole(out.places, 1);
    survey_edges(topology, shells, whole, out);
    std::vector<double> volume_m3(out.places);
    std::vector<std::uint8_t> used(out.places);
    const Vec3d middle = 0.5 * (out.min_m + out.max_m);  // a nearby point, so that sums keep their precision
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto at = [&](std::size_t k) {
            return to_double(mesh.vertices_m[mesh.triangles[i][k]]) - middle;
        };
        const std::uint32_t shell = shells.of(topology.corners[i][0]);
        volume_m3[shell] += dot(at(0), cross(at(1), at(2))) / 6;
        used[shell] = 1;
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
        out.shells += used[i];
        out.inverted_shells += used[i] && whole[i] && volume_m3[i] < 0;
    }
    survey_repeats(std::move(topology.corners), out);
}

void survey_triangles(const Mesh& mesh, MeshSurvey& out) {
    for (const MeshSurface& surface : mesh.surfaces)
        out.surfaces.push_back({surface.name, 0, 0, surface.base_color_texture >= 0});
    out.min_m = out.max_m = to_double(mesh.vertices_m[mesh.triangles.front()[0]]);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        std::array<Vec3d, 3> p;
        Vec3d normal;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[i][k];
            p[k] = to_double(mesh.vertices_m[vertex]);
            out.min_m = {std::min(out.min_m.x, p[k].x), std::min(out.min_m.y, p[k].y),
                         std::min(out.min_m.z, p[k].z)};
            out.max_m = {std::max(out.max_m.x, p[k].x), std::max(out.max_m.y, p[k].y),
                         std::max(out.max_m.z, p[k].z)};
            if (!mesh.normals.empty()) normal = normal + to_double(mesh.normals[vertex]);
        }
        const Vec3d face = cross(p[1] - p[0], p[2] - p[0]);
        const double side_m = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
        out.sliver_triangles += length(face) < kSliver * side_m * side_m;
        out.opposed_normals += dot(face, normal) < 0;
        SurveyedSurface& surface = out.surfaces[mesh.surface_of_triangle[i]];
        ++surface.triangles;
        surface.area_m2 += 0.5 * length(face);
    }
    // Importers add a default material that no triangle uses.
    std::erase_if(out.surfaces, [](const SurveyedSurface& surface) { return surface.triangles == 0; });
}

}  // namespace

namespace {

// Coordinates are kept in single precision, as in files.
double coarse_step_m(Vec3d min_m, Vec3d max_m) {
    const double farthest_m = std::max({-min_m.x, -min_m.y, -min_m.z, max_m.x, max_m.y, max_m.z});
    const double step_m = farthest_m * static_cast<double>(std::numeric_limits<float>::epsilon());
    return step_m > 1e-4 * length(max_m - min_m) ? step_m : 0;
}

}  // namespace

MeshSurvey survey_mesh(const MeshContents& contents, const std::string& file) {
    const Mesh& mesh = contents.mesh;
    MeshSurvey out;
    out.file = file;
    out.triangles = mesh.triangles.size();
    out.vertices = mesh.vertices_m.size();
    out.nodes = contents.nodes;
    out.collapsed_triangles = contents.collapsed_triangles;
    out.has_normals = !mesh.normals.empty();
    survey_triangles(mesh, out);
    survey_topology(mesh, out);
    const Vec3d size_m = out.max_m - out.min_m;
    out.probably_mm = std::max({size_m.x, size_m.y, size_m.z}) > kLongestSide_m;
    out.coarse_step_m = coarse_step_m(out.min_m, out.max_m);
    out.opposed_normals += contents.opposed_facets;
    out.leaning_normals = contents.leaning_facets;
    out.missing_materials = contents.missing_materials;
    out.unreadable_textures = contents.unreadable_textures;
    out.remarks = contents.remarks;
    out.left_out = mesh.left_out;
    return out;
}

std::vector<std::string> problems_of(const MeshSurvey& s) {
    std::vector<std::string> out;
    const auto tell = [&](std::uint64_t count, const char* what, const char* advice) {
        if (count > 0) out.push_back(fmt::format("{} {}: {}", count, what, advice));
    };
    if (s.probably_mm)
        out.push_back(
            "it is very large: probably in millimetres; 'scale: 0.001' in the scenario converts them to "
            "metres");
    if (s.coarse_step_m > 0)
        out.push_back(
            fmt::format("it is so far from its origin that single precision moves its vertices by up to "
                        "{:.2g} m: subtract its centre from the coordinates",
                        s.coarse_step_m));
    for (const std::string& file : s.missing_materials)
        out.push_back(fmt::format("no file {}: surfaces with its materials are grey", in_quotes(file)));
    out.insert(out.end(), s.unreadable_textures.begin(), s.unreadable_textures.end());
    out.insert(out.end(), s.remarks.begin(), s.remarks.end());
    for (const std::string& look : s.left_out) out.push_back(harmless(look));
    tell(s.open_edges, "open edges", "the mesh is not closed there, and shows its other side");
    tell(s.inconsistent_edges, "inconsistent edges", "the two triangles at the edge face opposite sides");
    tell(s.inverted_shells, "inverted shells", "closed surfaces with triangles that face inwards");
    tell(s.crowded_edges, "edges of three triangles or more",
         "surfaces that meet inside others, or are duplicated");
    tell(s.opposed_normals, "triangles with opposed normals",
         "the file's normals are opposite to the vertex order");
    tell(s.leaning_normals, "facets with tilted normals",
         "the file's normals differ from the vertex order, which is used");
    tell(s.collapsed_triangles, "collapsed triangles", "two vertices at one place; they are left out");
    tell(s.sliver_triangles, "slivers", "triangles with vertices on one line");
    tell(s.repeated_triangles, "repeated triangles", "either of two triangles in the same place may be seen");
    return out;
}

std::string to_text(const MeshSurvey& s) {
    constexpr std::size_t kMaxNodesShown = 200;
    const Vec3d size_m = s.max_m - s.min_m;
    std::string out = fmt::format(
        "mesh {}\nsize       {:.6g} x {:.6g} x {:.6g} m: x {:.6g} to {:.6g}, y {:.6g} to {:.6g}, z {:.6g} to "
        "{:.6g}\n"
        "triangles  {} in {} shells; {} vertices at {} places; {}\n",
        harmless(s.file), size_m.x, size_m.y, size_m.z, s.min_m.x, s.max_m.x, s.min_m.y, s.max_m.y, s.min_m.z,
        s.max_m.z, s.triangles, s.shells, s.vertices, s.places,
        s.has_normals ? "with normals" : "without normals: flat");
    out += fmt::format("surfaces   {}\n", s.surfaces.size());
    for (const SurveyedSurface& surface : s.surfaces)
        out += fmt::format("  {:>10} triangles  {:>10.4g} m2  {}{}\n", surface.triangles, surface.area_m2,
                           surface.name.empty() ? "without a name" : "'" + harmless(surface.name) + "'",
                           surface.textured ? ", with a texture" : "");
    out += fmt::format("nodes      {}\n", s.nodes.size());
    for (std::size_t i = 0; i < std::min(s.nodes.size(), kMaxNodesShown); ++i)
        out += fmt::format("  {:>10} triangles  {:{}}'{}'\n", s.nodes[i].triangles, "",
                           2 * std::min(s.nodes[i].depth, 20u), harmless(s.nodes[i].name));
    if (s.nodes.size() > kMaxNodesShown)
        out += fmt::format("  and {} more: --json has them all\n", s.nodes.size() - kMaxNodesShown);
    const std::vector<std::string> problems = problems_of(s);
    out += problems.empty() ? "problems: none\n" : "problems:\n";
    for (const std::string& problem : problems) out += "  " + problem + "\n";
    return out;
}

}  // namespace hilcam
