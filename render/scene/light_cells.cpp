#include "render/scene/light_cells.h"

#include <tbb/parallel_for.h>

namespace hilcam {
namespace {

void merge_equal(std::vector<FoundCell>& cells) {
    std::stable_sort(cells.begin(), cells.end(),
                     [](const FoundCell& a, const FoundCell& b) { return a.key < b.key; });
    std::size_t out = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (out > 0 && cells[out - 1].key == cells[i].key)
            cells[out - 1].add(cells[i]);
        else
            cells[out++] = cells[i];
    }
    cells.resize(out);
}

// Runs of triangles, a fixed number of them: sums do not depend on how many threads there are.
constexpr std::size_t kRuns = 256;

// round: of those that draw points. wanted: only cells that it has, sorted; null: all.
std::vector<FoundCell> draw_cells(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                                  std::uint64_t round, const std::vector<std::uint64_t>* wanted) {
    std::vector<std::vector<FoundCell>> runs(kRuns);
    tbb::parallel_for(std::size_t{0}, kRuns, [&](std::size_t run) {
        std::vector<FoundCell>& out = runs[run];
        const std::size_t count = mesh.triangles.size();
        for (std::size_t t = count * run / kRuns; t < count * (run + 1) / kRuns; ++t) {
            const std::uint16_t surface = mesh.surface_of_triangle[t];
            if (!keeps[surface]) continue;
            const TriangleSpread spread(mesh, t, 0.5f * grid.cube_m);
            if (!(spread.area_m2 > 0)) continue;
            const float share = spread.area_m2 / static_cast<float>(spread.points());
            for (int i = 0; i < spread.points(); ++i) {
                const Cube cube = grid.cube(spread.at(spread.weights(i)));
                const auto number = static_cast<std::uint32_t>(i);
                // By area, without order: the least of -ln(u) / area (Efraimidis & Spirakis, Inf. Process.
                // Lett. 97, 2006).
                const float u =
                    (static_cast<float>(mixed(round << 56 ^ (t << 24 | number)) >> 41) + 0.5f) * 0x1p-23f;
                const float priority = -std::log(u) / share;
                for (const bool back : {false, true}) {
                    FoundCell cell;
                    cell.key = key_of(cube, kind_of({back ? -spread.normal : spread.normal, surface, back}));
                    if (wanted && !std::binary_search(wanted->begin(), wanted->end(), cell.key)) continue;
                    cell.area_m2 = share;
                    cell.add(CellPoint{priority, static_cast<std::uint32_t>(t), number, back});
                    // Neighbours in a run are mostly of one cell.
                    if (!out.empty() && out.back().key == cell.key)
                        out.back().add(cell);
                    else if (out.size() > 1 && out[out.size() - 2].key == cell.key)
                        out[out.size() - 2].add(cell);
                    else
                        out.push_back(cell);
                }
            }
        }
        merge_equal(out);
    });
    std::vector<FoundCell> all;
    for (std::vector<FoundCell>& run : runs) {
        all.insert(all.end(), run.begin(), run.end());
        run = {};
    }
    merge_equal(all);
    return all;
}

// Keeps a cell's points, each with the chance that it is seen.
void keep_open(const Mesh& mesh, const CubeGrid& grid, float above_m, const Openness& openness,
               std::vector<FoundCell>& cells) {
    tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t c) {
        FoundCell& cell = cells[c];
        int open = 0;
        for (int i = 0; i < cell.count; ++i) {
            const CellPoint point = cell.best[static_cast<std::size_t>(i)];
            const TriangleSpread spread(mesh, point.triangle, 0.5f * grid.cube_m);
            const Vec3f normal = point.back ? -spread.normal : spread.normal;
            const Vec3f at = spread.at(spread.weights(static_cast<int>(point.point))) + above_m * normal;
            const std::uint64_t word = mixed(cell.key ^ (std::uint64_t{point.triangle} << 24 | point.point));
            const float u = static_cast<float>(word >> 40) * 0x1p-24f;
            // A point in a corner is seen as well as one that stands free; one that looks out of a slit is
            // not.
            if (u < 3 * openness(at, normal, 0.5f * grid.cube_m))
                cell.best[static_cast<std::size_t>(open++)] = point;
        }
        cell.count = open;
    });
}

}  // namespace

std::vector<FoundCell> find_cells(const Mesh& mesh, std::span<const std::uint8_t> keeps,
                                  const CubeGrid& grid) {
    return draw_cells(mesh, keeps, grid, 0, nullptr);
}

void prefer_open_points(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                        float above_m, const Openness& openness, std::vector<FoundCell>& cells) {
    constexpr std::uint64_t kRounds = 8;
    std::vector<FoundCell> open = cells;
    keep_open(mesh, grid, above_m, openness, open);
    for (std::uint64_t round = 1; round < kRounds; ++round) {
        std::vector<std::uint64_t> wanted;
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (open[c].count < cells[c].count) wanted.push_back(cells[c].key);
        if (wanted.empty()) break;
        std::vector<FoundCell> drawn = draw_cells(mesh, keeps, grid, round, &wanted);
        keep_open(mesh, grid, above_m, openness, drawn);
        std::size_t c = 0;
        for (const FoundCell& more : drawn) {
            while (open[c].key != more.key) ++c;
            for (int i = 0; i < more.count && open[c].count < cells[c].count; ++i)
                open[c].best[static_cast<std::size_t>(open[c].count++)] =
                    more.best[static_cast<std::size_t>(i)];
        }
    }
    for (std::size_t c = 0; c < cells.size(); ++c)
        if (open[c].count > 0) cells[c].count = open[c].count, cells[c].best = open[c].best;
}

MeshExtent extent_of(const Mesh& mesh, std::span<const std::uint8_t> keeps) {
    MeshExtent e{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!keeps[mesh.surface_of_triangle[t]]) continue;
        const auto& corners = mesh.triangles[t];
        for (const std::uint32_t v : corners) {
            const Vec3f p = mesh.vertices_m[v];
            e.least = {std::min(e.least.x, p.x), std::min(e.least.y, p.y), std::min(e.least.z, p.z)};
            e.most = {std::max(e.most.x, p.x), std::max(e.most.y, p.y), std::max(e.most.z, p.z)};
        }
        const Vec3f a = mesh.vertices_m[corners[0]];
        e.area_m2 += 0.5 * static_cast<double>(length(
                               cross(mesh.vertices_m[corners[1]] - a, mesh.vertices_m[corners[2]] - a)));
    }
    return e;
}

}  // namespace hilcam
