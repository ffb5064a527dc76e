#include "render/lod/mesh_lod.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "render/lod/shaped_parts.h"
#include "render/lod/triangle_order.h"

namespace hilcam {
namespace {

constexpr std::size_t kSmallMesh = 2000;  // triangles; smaller meshes gain nothing
// Shaped parts may have this fraction of a level's error. With a fourth the light of `geo_inspection` from 50
// m is off by 2.3 %, with an eighth by 1.9, with a sixteenth by 1.8
// (docs/decisions.md#levels-of-detail-keep-borders-and-shapes).
constexpr double kShapeFiner = 8;

// The vertices of a surface's triangles, each once, in order of first use.
struct Submesh {
    std::vector<std::uint32_t> vertices;  // into the mesh
    std::vector<unsigned> indices;        // into `vertices`, three a triangle
};

Submesh submesh_of(const Mesh& mesh, std::span<const std::uint32_t> triangles,
                   std::vector<std::uint32_t>& scratch) {
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    scratch.resize(mesh.vertices_m.size(), kNone);
    Submesh out;
    for (const std::uint32_t t : triangles)
        for (const std::uint32_t v : mesh.triangles[t]) {
            if (scratch[v] == kNone) {
                scratch[v] = static_cast<std::uint32_t>(out.vertices.size());
                out.vertices.push_back(v);
            }
            out.indices.push_back(scratch[v]);
        }
    for (const std::uint32_t v : out.vertices) scratch[v] = kNone;
    return out;
}

double area_of(const Mesh& mesh, std::uint16_t surface) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.surface_of_triangle[i] == surface) sum += length(area_vector(mesh, mesh.triangles[i]));
    return sum;
}

// Flat-shaded surfaces have separate corners for every triangle and could never be collapsed. If most corners
// are such, equal places become one vertex, and the level has no normals there (a zero normal means the
// facet's own).
bool weld_facets(Submesh& part, std::vector<Vec3f>& positions) {
    std::vector<unsigned> remap(positions.size());
    const std::size_t places = meshopt_generateVertexRemap(remap.data(), nullptr, positions.size(),
                                                           positions.data(), positions.size(), sizeof(Vec3f));
    if (2 * places > positions.size()) return false;
    std::vector<Vec3f> welded(places);
    std::vector<std::uint32_t> vertices(places);
    for (std::size_t i = 0; i < positions.size(); ++i)
        welded[remap[i]] = positions[i], vertices[remap[i]] = part.vertices[i];
    for (unsigned& index : part.indices) index = remap[index];
    positions = std::move(welded), part.vertices = std::move(vertices);
    return true;
}

// Returns the alpha of flattened wrinkles from the loss of area: a facet that leans by theta has 1 / cos
// theta times the area that it covers. For GGX-like slopes of mean square alpha^2 the ratio is about 1 +
// alpha^2 / 2 (small slopes).
float flattened_alpha(double area, double level_area) {
    if (!(level_area > 0) || area <= level_area) return 0;
    return static_cast<float>(std::min(1.0, std::sqrt(2 * (area / level_area - 1))));
}

// meshoptimizer compares each triangle at a vertex with all others there; for a fan of 100,000 it needs a
// minute. Meshes with such vertices are not simplified.
bool is_crowded(std::span<const unsigned> indices, std::span<const Vec3f> positions) {
    constexpr std::uint32_t kMaxAtAPlace = 4096;
    std::vector<unsigned> places(indices.size());
    meshopt_generateShadowIndexBuffer(places.data(), indices.data(), indices.size(), positions.data(),
                                      positions.size(), sizeof(Vec3f), sizeof(Vec3f));
    std::vector<std::uint32_t> triangles(positions.size());
    return std::any_of(places.begin(), places.end(),
                       [&](unsigned place) { return ++triangles[place] > kMaxAtAPlace; });
}

// A mesh, with a flag for each triangle that belongs to a shaped part.
struct Divided {
    Mesh mesh;
    std::vector<bool> shaped;
};

// Appends the rest of a part of a mesh to a level. kept: corners, three per triangle.
void append(const Mesh& mesh, const Submesh& part, std::span<const unsigned> kept, bool faceted,
            std::uint16_t surface, Mesh& out) {
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(part.vertices.size(), kNone);
    for (std::size_t i = 0; i + 2 < kept.size(); i += 3) {
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const unsigned v = kept[i + k];
            if (place[v] == kNone) {
                place[v] = static_cast<std::uint32_t>(out.vertices_m.size());
                const std::uint32_t from = part.vertices[v];
                out.vertices_m.push_back(mesh.vertices_m[from]);
                if (!mesh.normals.empty()) out.normals.push_back(faceted ? Vec3f{} : mesh.normals[from]);
                if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[from]);
            }
            triangle[k] = place[v];
        }
        out.triangles.push_back(triangle);
        out.surface_of_triangle.push_back(surface);
    }
}

void append_simplified(const Mesh& mesh, Submesh part, float error_m, std::uint16_t surface, Mesh& out) {
    std::vector<Vec3f> positions;
    for (const std::uint32_t v : part.vertices) positions.push_back(mesh.vertices_m[v]);
    const bool faceted = weld_facets(part, positions);
    const float scale = meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(Vec3f));
    std::vector<unsigned> kept = part.indices;
    // Down to nothing if the error permits it: what is smaller than the error does not matter.
    if (!is_crowded(part.indices, positions))
        kept.resize(scale > 0 ? meshopt_simplify(kept.data(), part.indices.data(), part.indices.size(),
                                                 &positions[0].x, positions.size(), sizeof(Vec3f), 3,
                                                 error_m / scale, meshopt_SimplifyLockBorder)
                              : 0);
    append(mesh, part, kept, faceted, surface, out);
}

// error_m: for parts that are not shaped.
Divided simplified(const Mesh& mesh, const std::vector<bool>& shaped, double error_m) {
    std::vector<std::array<std::vector<std::uint32_t>, 2>> by_surface(mesh.surfaces.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        by_surface[mesh.surface_of_triangle[i]][shaped[i]].push_back(i);
    Divided out;
    out.mesh.surfaces = mesh.surfaces;
    std::vector<std::uint32_t> scratch;
    for (std::size_t s = 0; s < by_surface.size(); ++s)
        for (const bool is_shaped : {false, true}) {
            const std::vector<std::uint32_t>& triangles = by_surface[s][is_shaped];
            if (triangles.empty()) continue;
            append_simplified(mesh, submesh_of(mesh, triangles, scratch),
                              static_cast<float>(is_shaped ? error_m / kShapeFiner : error_m),
                              static_cast<std::uint16_t>(s), out.mesh);
            out.shaped.resize(out.mesh.triangles.size(), is_shaped);
        }
    return out;
}

std::vector<bool> in_order(const std::vector<bool>& of, std::span<const std::uint32_t> order) {
    std::vector<bool> out;
    out.reserve(of.size());
    for (const std::uint32_t i : order) out.push_back(of[i]);
    return out;
}

double size_m(const Mesh& mesh) {
    Vec3f least{1e30f, 1e30f, 1e30f}, most{-1e30f, -1e30f, -1e30f};
    for (const Vec3f& v : mesh.vertices_m) {
        least = {std::min(least.x, v.x), std::min(least.y, v.y), std::min(least.z, v.z)};
        most = {std::max(most.x, v.x), std::max(most.y, v.y), std::max(most.z, v.z)};
    }
    return static_cast<double>(length(most - least));
}

}  // namespace

std::vector<MeshLevel> coarser_levels(const Mesh& mesh) {
    std::vector<MeshLevel> levels;
    if (mesh.triangles.size() < kSmallMesh) return levels;
    std::vector<double> areas;
    for (std::size_t s = 0; s < mesh.surfaces.size(); ++s)
        areas.push_back(area_of(mesh, static_cast<std::uint16_t>(s)));
    std::vector<bool> shaped = find_shaped(mesh);
    const double size = size_m(mesh);
    for (double error_m = size / 65536; error_m < size / 32; error_m *= 2) {
        const Mesh& finer = levels.empty() ? mesh : levels.back().mesh;
        if (finer.triangles.size() < kSmallMesh) break;
        Divided made = simplified(finer, shaped, error_m);
        if (made.mesh.triangles.empty()) break;
        if (10 * made.mesh.triangles.size() > 6 * finer.triangles.size()) continue;
        shaped = in_order(made.shaped, order_triangles(made.mesh));
        // Errors of levels made from levels add up.
        MeshLevel level{std::move(made.mesh), error_m + (levels.empty() ? 0 : levels.back().error_m), {}, {}};
        level.lod_normals = lod_normals_of(mesh, level.mesh, level.error_m);
        for (std::size_t s = 0; s < mesh.surfaces.size(); ++s)
            level.flattened_alpha.push_back(
                flattened_alpha(areas[s], area_of(level.mesh, static_cast<std::uint16_t>(s))));
        levels.push_back(std::move(level));
    }
    return levels;
}

}  // namespace hilcam
