#include "render/levels/facet_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "render/levels/closest_triangle.h"

namespace hilcam {
namespace {

// A cell is not smaller than this share of what looks at it.
constexpr float kOfWidth = 0.7f;

std::uint32_t cell_count(std::uint32_t depth) { return 1u << 2 * depth; }
// Number of all cells before those of a depth.
std::uint32_t cells_before(std::uint32_t depth) { return (cell_count(depth) - 4) / 3; }

// Numbers the cell of a place: along each row of u those that stand as the triangle does and those upside down, in turns.
std::uint32_t cell_at(std::uint32_t depth, float u, float v) {
    const std::uint32_t n = 1u << depth;
    const auto scale = static_cast<float>(n);
    const float x = std::min(std::max(0.0f, scale * u), scale),
                y = std::min(std::max(0.0f, scale * v), scale);
    const std::uint32_t row = std::min(static_cast<std::uint32_t>(y), n - 1);
    const std::uint32_t column = std::min(static_cast<std::uint32_t>(x), n - 1 - row);
    const float beyond = x - static_cast<float>(column) + y - static_cast<float>(row);
    const bool upside_down = beyond > 1 && column + row + 1 < n;
    return row * (2 * n - row) + 2 * column + (upside_down ? 1 : 0);
}

// The shading normal at a place in a triangle; `geometric` where it has none.
Vec3f normal_at(const Mesh& mesh, std::uint32_t triangle, float u, float v, Vec3f geometric) {
    if (mesh.normals.empty()) return geometric;
    const auto& t = mesh.triangles[triangle];
    for (const std::uint32_t corner : t)
        if (!(dot(mesh.normals[corner], mesh.normals[corner]) > 0)) return geometric;
    const Vec3f n = (1 - u - v) * mesh.normals[t[0]] + u * mesh.normals[t[1]] + v * mesh.normals[t[2]];
    return dot(n, n) > 1e-6f ? normalized(n) : geometric;
}

// A triangle of the mesh, and where in the level's that stands for it.
struct OwnedPart {
    std::uint32_t owner = std::numeric_limits<std::uint32_t>::max();  // none
    std::uint32_t number = 0;
    float u = 0, v = 0;
    LevelFacets::Part part{};
};

OwnedPart part_of(const Mesh& mesh, const Mesh& level, const ClosestTriangle& near, std::uint32_t number,
                  float radius_m) {
    const auto& corners = mesh.triangles[number];
    const Vec3f area = to_float(area_vector(mesh, corners));
    const float size = length(area);
    if (!(size > 0 && std::isfinite(size))) return {};
    const Vec3f middle_m =
        (mesh.vertices_m[corners[0]] + mesh.vertices_m[corners[1]] + mesh.vertices_m[corners[2]]) / 3.0f;
    const auto found = near.find({middle_m, area, mesh.surface_of_triangle[number], radius_m});
    if (!found) return {};
    const Vec3f flat = to_float(normalized(area_vector(level, level.triangles[found->triangle])));
    const Vec3f lean = normal_at(mesh, number, 1.0f / 3, 1.0f / 3, area / size) -
                       normal_at(level, found->triangle, found->u, found->v, flat);
    return {found->triangle, number, found->u, found->v, {size, lean}};
}

LevelFacets facets_of_parts(std::span<const OwnedPart> owned) {
    std::vector<LevelFacets::Part> parts;
    for (const OwnedPart& p : owned) parts.push_back(p.part);
    return LevelFacets::of(parts);
}

float longest_side_m(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3f a = mesh.vertices_m[triangle[0]], b = mesh.vertices_m[triangle[1]],
                c = mesh.vertices_m[triangle[2]];
    return std::max({length(a - b), length(b - c), length(c - a)});
}

// As deep as there is a part for each cell.
std::uint32_t depth_for(std::size_t parts) {
    std::uint32_t depth = 0;
    while (depth < FacetMap::kMaxDepth && cell_count(depth + 1) <= parts) ++depth;
    return depth;
}

// The cells of a depth: of their own parts, or as the larger cell is in which they lie.
void divide(std::span<OwnedPart> owned, std::uint32_t depth, FacetMap& map) {
    const std::uint32_t triangle = owned.front().owner, n = 1u << depth;
    LevelFacets* const cells = &map.cells[map.divisions[triangle].first + cells_before(depth)];
    const LevelFacets* const larger =
        depth > 1 ? &map.cells[map.divisions[triangle].first + cells_before(depth - 1)]
                  : &map.whole[triangle];
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t i = 0; i < 2 * (n - row) - 1; ++i) {
            const float off = i % 2 == 0 ? 1.0f / 3 : 2.0f / 3;
            const float u = (static_cast<float>(i / 2) + off) / static_cast<float>(n),
                        v = (static_cast<float>(row) + off) / static_cast<float>(n);
            cells[row * (2 * n - row) + i] = larger[cell_at(depth - 1, u, v)];
        }
    const auto cell = [&](const OwnedPart& p) { return cell_at(depth, p.u, p.v); };
    std::sort(owned.begin(), owned.end(), [&](const OwnedPart& a, const OwnedPart& b) {
        return cell(a) != cell(b) ? cell(a) < cell(b) : a.number < b.number;
    });
    for (std::size_t first = 0, end; first < owned.size(); first = end) {
        end = first + 1;
        while (end < owned.size() && cell(owned[end]) == cell(owned[first])) ++end;
        cells[cell(owned[first])] = facets_of_parts(owned.subspan(first, end - first));
    }
}

// Parts by their owners; those of none are left out.
std::vector<std::span<OwnedPart>> by_owner(std::vector<OwnedPart>& parts, std::size_t owners) {
    // Equal ones keep the mesh's order, whatever the thread count.
    tbb::parallel_sort(parts.begin(), parts.end(), [](const OwnedPart& a, const OwnedPart& b) {
        return a.owner != b.owner ? a.owner < b.owner : a.number < b.number;
    });
    std::vector<std::span<OwnedPart>> out;
    for (std::size_t first = 0, end; first < parts.size() && parts[first].owner < owners; first = end) {
        end = first + 1;
        while (end < parts.size() && parts[end].owner == parts[first].owner) ++end;
        out.emplace_back(&parts[first], end - first);
    }
    return out;
}

}  // namespace

const LevelFacets& FacetMap::at(const Place& place, float width_m) const {
    const Division& division = divisions[place.triangle];
    std::uint32_t depth = 0;
    for (float side_m = 0.5f * division.side_m; depth < division.depth && side_m >= kOfWidth * width_m;
         side_m *= 0.5f)
        ++depth;
    if (depth == 0) return whole[place.triangle];
    return cells[division.first + cells_before(depth) + cell_at(depth, place.u, place.v)];
}

bool FacetMap::is_whole(std::size_t triangles) const {
    return whole.size() == triangles && divisions.size() == triangles &&
           std::all_of(divisions.begin(), divisions.end(), [&](const Division& d) {
               return d.depth <= kMaxDepth &&
                      d.first + std::size_t{cells_before(d.depth + 1)} <= cells.size();
           });
}

FacetMap facets_of(const Mesh& mesh, const Mesh& level, double error_m) {
    FacetMap map;
    map.whole.assign(level.triangles.size(), LevelFacets::flat());
    map.divisions.resize(level.triangles.size());
    const ClosestTriangle near(level);
    const auto radius_m = static_cast<float>(4 * error_m);
    std::vector<OwnedPart> parts(mesh.triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, parts.size(), 1024), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            parts[i] = part_of(mesh, level, near, static_cast<std::uint32_t>(i), radius_m);
    });
    const std::vector<std::span<OwnedPart>> owned = by_owner(parts, level.triangles.size());
    tbb::parallel_for(std::size_t{0}, owned.size(),
                      [&](std::size_t i) { map.whole[owned[i].front().owner] = facets_of_parts(owned[i]); });
    std::uint32_t count = 0;
    for (const std::span<OwnedPart>& of_one : owned) {
        const std::uint32_t triangle = of_one.front().owner;
        const std::uint32_t depth = map.is_flat(triangle) ? 0 : depth_for(of_one.size());
        map.divisions[triangle] = {count, depth, longest_side_m(level, level.triangles[triangle])};
        count += cells_before(depth + 1);
    }
    map.cells.resize(count);
    tbb::parallel_for(std::size_t{0}, owned.size(), [&](std::size_t i) {
        const FacetMap::Division& division = map.divisions[owned[i].front().owner];
        for (std::uint32_t depth = 1; depth <= division.depth; ++depth) divide(owned[i], depth, map);
    });
    return map;
}

}  // namespace hilcam
