#pragma once
// Divides a mesh into the cells of surface_probes.h, and chooses some points on each.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "render/probes/probe_cell_key.h"
#include "render/probes/surface_probes.h"

namespace hilcam {

struct Corner {
    Vec3f m;
    std::uint32_t vertex;
};

// A triangle with its longest edge from b to c, and the grid of points spread over it.
struct TriangleSpread {
    std::array<Corner, 3> corner;  // apex, b, c
    int along = 1, across = 1;
    float area_m2 = 0;
    Vec3f normal;

    TriangleSpread(const Mesh& mesh, std::size_t triangle, float step_m) {
        const auto& t = mesh.triangles[triangle];
        const auto at = [&](std::size_t i) { return Corner{mesh.vertices_m[t[i]], t[i]}; };
        std::size_t apex = 0;
        float longest = -1;
        for (std::size_t i = 0; i < 3; ++i) {
            const float edge_m = length(at((i + 2) % 3).m - at((i + 1) % 3).m);
            if (edge_m > longest) longest = edge_m, apex = i;
        }
        corner = {at(apex), at((apex + 1) % 3), at((apex + 2) % 3)};
        const Vec3f twice = cross(corner[1].m - corner[0].m, corner[2].m - corner[0].m);
        const float size = length(twice);
        area_m2 = 0.5f * size;
        if (!(size > 0) || !std::isfinite(size)) {
            area_m2 = 0;
            return;
        }
        normal = twice / size;
        const float most = 4096;
        along = static_cast<int>(std::clamp(std::ceil(longest / step_m), 1.0f, most));
        across = static_cast<int>(std::clamp(std::ceil(size / longest / step_m), 1.0f, most));
    }
    int points() const { return along * across; }
    // Returns the weights of the corners for point i; points represent equal areas (Turk, Graphics Gems,
    // 1990, p. 24).
    Vec3f weights(int i) const {
        const float r1 = std::sqrt((static_cast<float>(i / along) + 0.5f) / static_cast<float>(across));
        const float r2 = (static_cast<float>(i % along) + 0.5f) / static_cast<float>(along);
        return {1 - r1, r1 * (1 - r2), r1 * r2};
    }
    Vec3f at(Vec3f w) const { return w.x * corner[0].m + w.y * corner[1].m + w.z * corner[2].m; }
};

struct CellPoint {
    float priority = 0;  // points with smaller values are taken first
    std::uint32_t triangle = 0;
    std::uint32_t point = 0;
    bool back = false;
};

// A cell while it is being found: its area, and candidates for its points.
struct FoundCell {
    std::uint64_t key = 0;  // key of all layers in the cube
    unsigned layer = 0;
    float lowest = 0, highest = 0;  // range of height_of() for what is in it
    double area_m2 = 0;
    int count = 0;
    // More than a probe needs, because a wall may divide them (probe_division.h).
    static constexpr int kMax = 2 * SurfaceProbe::kPoints;
    std::array<CellPoint, kMax> best;

    void add(const CellPoint& candidate) {
        const auto before = [](const CellPoint& a, const CellPoint& b) {
            return std::tuple(a.priority, a.triangle, a.point) < std::tuple(b.priority, b.triangle, b.point);
        };
        auto end = best.begin() + count;
        const auto place = std::upper_bound(best.begin(), end, candidate, before);
        if (place == best.end()) return;
        if (count < kMax) ++count, ++end;
        std::move_backward(place, end - 1, end);
        *place = candidate;
    }
    void add(const FoundCell& other) {
        area_m2 += other.area_m2;
        lowest = std::min(lowest, other.lowest), highest = std::max(highest, other.highest);
        for (int i = 0; i < other.count; ++i) add(other.best[static_cast<std::size_t>(i)]);
    }
    auto order() const { return std::tuple(key, layer); }
};

struct MeshExtent {
    Vec3f least, most;
    double area_m2 = 0;
};

// Returns the extent of the surfaces that cache light.
MeshExtent extent_of(const Mesh& mesh, std::span<const std::uint8_t> keeps);
// Finds the cells, sorted by key and layer. Runs on oneTBB; the result does not depend on the number of
// threads.
std::vector<FoundCell> find_cells(const Mesh& mesh, std::span<const std::uint8_t> keeps,
                                  const CubeGrid& grid);

// Replaces hidden points of cells by visible ones, each with the probability that it is visible: most of a
// panel may be under tiles, and only the gaps are seen. A point in a nook (something is within a twentieth of
// a cube) is used only if a cell has no others: four points represent the whole cell, and one beside a sunlit
// lip of a millimetre would spread its light over a quarter. A cell that is completely hidden keeps its
// points. above_m: height of the points above the surface.
void prefer_open_points(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                        float above_m, const Openness& openness, std::vector<FoundCell>& cells);

}  // namespace hilcam
