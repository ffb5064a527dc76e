#include "render/lod/shaped_parts.h"

#include <meshoptimizer.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

#include "render/lod/joined_sets.h"

namespace hilcam {
namespace {

// Parts bent by less than this, on average over their edges, are flat [rad]: rounding of positions bends a
// fine mesh by a tenth of it.
constexpr double kFlat_rad = 1e-3;
// The smallest ratio of a shaped part's sum of curvature to the sum of absolute values, chosen half-way
// between foil and masts.
constexpr double kOneSided = 0.5;

// A side of a triangle, between two places.
struct Side {
    std::uint32_t from, to;  // from < to
    std::uint32_t triangle;
    std::uint32_t beyond;  // the triangle's third corner
    bool operator<(const Side& other) const {
        return std::tie(from, to, triangle) < std::tie(other.from, other.to, other.triangle);
    }
};

// Corners at one place get one number. The sides of an edge are adjacent.
std::vector<Side> sides_of(const Mesh& mesh) {
    const std::size_t count = 3 * mesh.triangles.size();
    std::vector<std::uint32_t> places(count);
    meshopt_generateShadowIndexBuffer(places.data(), mesh.triangles[0].data(), count, &mesh.vertices_m[0].x,
                                      mesh.vertices_m.size(), sizeof(Vec3f), sizeof(Vec3f));
    std::vector<Side> sides;
    sides.reserve(count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t* corner = &places[3 * std::size_t{t}];
        // A triangle without width does not separate its neighbours.
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [from, to] = std::minmax(corner[k], corner[(k + 1) % 3]);
            sides.push_back({from, to, t, corner[(k + 2) % 3]});
        }
    }
    tbb::parallel_sort(sides.begin(), sides.end());
    return sides;
}

// The bend of two triangles at their edge; angles are positive if convex.
struct Bend {
    double length_m, angle_rad;
};
Bend bend_of(const Mesh& mesh, const Side& side, const Side& other) {
    const auto place_m = [&](std::uint32_t vertex) { return to_double(mesh.vertices_m[vertex]); };
    const Vec3d area = area_vector(mesh, mesh.triangles[side.triangle]),
                other_area = area_vector(mesh, mesh.triangles[other.triangle]);
    const double angle_rad = angle_between_rad(area, other_area);
    const bool convex = dot(area, place_m(other.beyond) - place_m(side.from)) < 0;
    return {length(place_m(side.to) - place_m(side.from)), convex ? angle_rad : -angle_rad};
}

// Calls each(...) for every edge that exactly two triangles of one surface share.
template <class Each>
void for_each_edge(const Mesh& mesh, std::span<const Side> sides, const Each& each) {
    for (std::size_t first = 0, end; first < sides.size(); first = end) {
        const Side& side = sides[first];
        for (end = first + 1; end < sides.size() && sides[end].from == side.from && sides[end].to == side.to;)
            ++end;
        if (end - first != 2) continue;
        const Side& other = sides[first + 1];
        if (mesh.surface_of_triangle[side.triangle] == mesh.surface_of_triangle[other.triangle])
            each(side, other);
    }
}

struct Curvature {
    double sum_m = 0, size_m = 0, edges_m = 0;
    bool is_shaped() const { return size_m > kFlat_rad * edges_m && std::abs(sum_m) >= kOneSided * size_m; }
};

}  // namespace

std::vector<bool> find_shaped(const Mesh& mesh) {
    std::vector<bool> shaped(mesh.triangles.size());
    if (shaped.empty()) return shaped;
    const std::vector<Side> sides = sides_of(mesh);
    JoinedSets parts(shaped.size());
    for_each_edge(mesh, sides,
                  [&](const Side& side, const Side& other) { parts.join(side.triangle, other.triangle); });
    std::vector<Curvature> curvature(shaped.size());
    for_each_edge(mesh, sides, [&](const Side& side, const Side& other) {
        const Bend bend = bend_of(mesh, side, other);
        Curvature& of_part = curvature[parts.of(side.triangle)];
        of_part.sum_m += bend.length_m * bend.angle_rad;
        of_part.size_m += bend.length_m * std::abs(bend.angle_rad);
        of_part.edges_m += bend.length_m;
    });
    for (std::uint32_t t = 0; t < shaped.size(); ++t) shaped[t] = curvature[parts.of(t)].is_shaped();
    return shaped;
}

}  // namespace hilcam
