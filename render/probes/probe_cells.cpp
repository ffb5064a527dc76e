#include "render/probes/probe_cells.h"

#include <tbb/parallel_for.h>

#include "render/vocabulary/mixed_bits.h"

namespace hilcam {
namespace {

void merge_equal(std::vector<FoundCell>& cells) {
    std::stable_sort(cells.begin(), cells.end(),
                     [](const FoundCell& a, const FoundCell& b) { return a.order() < b.order(); });
    std::size_t out = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (out > 0 && cells[out - 1].order() == cells[i].order())
            cells[out - 1].add(cells[i]);
        else
            cells[out++] = cells[i];
    }
    cells.resize(out);
}

// Adds to a cell among the last ones, because neighbours in a run are mostly in one cell.
void append(std::vector<FoundCell>& cells, const FoundCell& cell) {
    for (std::size_t back = 1; back <= 2 && back <= cells.size(); ++back)
        if (cells[cells.size() - back].order() == cell.order()) return cells[cells.size() - back].add(cell);
    cells.push_back(cell);
}

// A fixed number of runs of triangles, so that sums do not depend on the number of threads.
constexpr std::size_t kRuns = 256;

// A point of a mesh and its place.
struct PointPlace {
    std::size_t triangle;
    std::uint32_t number;  // number in the triangle
    float share_m2;        // its share of the triangle's area
    std::uint16_t surface;
    Vec3f normal;  // normal of the triangle's own side
    Cube cube;
    Vec3f at;  // in cubes

    std::uint64_t key(bool back) const {
        return key_of(cube, kind_of({back ? -normal : normal, surface, back}));
    }
    float height(std::uint64_t key) const { return height_of(kind_in(key), at); }
};
float middle_of(std::uint64_t key) {
    const Cube c = cube_of(key);
    return height_of(kind_in(key), {static_cast<float>(c.x) + 0.5f, static_cast<float>(c.y) + 0.5f,
                                    static_cast<float>(c.z) + 0.5f});
}

// Calls visit(place) for each point of a run's triangles whose surface caches light.
template <class Visit>
void for_each_point(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                    std::size_t run, const Visit& visit) {
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = count * run / kRuns; t < count * (run + 1) / kRuns; ++t) {
        const std::uint16_t surface = mesh.surface_of_triangle[t];
        if (!keeps[surface]) continue;
        const TriangleSpread spread(mesh, t, 0.5f * grid.cube_m);
        if (!(spread.area_m2 > 0)) continue;
        const float share_m2 = spread.area_m2 / static_cast<float>(spread.points());
        for (int i = 0; i < spread.points(); ++i) {
            const Vec3f point_m = spread.at(spread.weights(i));
            visit(PointPlace{t, static_cast<std::uint32_t>(i), share_m2, surface, spread.normal,
                             grid.cube(point_m), (point_m - grid.corner_m) / grid.cube_m});
        }
    }
}

// The layers of those keys that have more than one, sorted by key.
class LayerMap {
  public:
    LayerMap(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid) {
        std::vector<std::vector<Of>> runs(kRuns);
        tbb::parallel_for(std::size_t{0}, kRuns, [&](std::size_t run) {
            std::vector<Of>& out = runs[run];
            for_each_point(mesh, keeps, grid, run, [&](const PointPlace& place) {
                for (const bool back : {false, true}) {
                    const std::uint64_t key = place.key(back);
                    std::size_t same = out.size();
                    for (std::size_t i = 1; i <= 2 && i <= out.size(); ++i)
                        if (out[out.size() - i].key == key) same = out.size() - i;
                    if (same == out.size()) out.push_back({key, {}});
                    out[same].layers.add(place.height(key), middle_of(key));
                }
            });
            merge(out);
        });
        for (std::vector<Of>& run : runs) {
            of_.insert(of_.end(), run.begin(), run.end());
            run = {};
        }
        merge(of_);
        std::erase_if(of_, [](const Of& one) { return one.layers.count() < 2; });
    }
    unsigned layer(std::uint64_t key, float height) const {
        const auto place = std::lower_bound(of_.begin(), of_.end(), key,
                                            [](const Of& one, std::uint64_t k) { return one.key < k; });
        return place != of_.end() && place->key == key ? place->layers.layer(height, middle_of(key)) : 0;
    }

  private:
    struct Of {
        std::uint64_t key;
        Layers layers;
    };
    std::vector<Of> of_;

    static void merge(std::vector<Of>& list) {
        std::sort(list.begin(), list.end(), [](const Of& a, const Of& b) { return a.key < b.key; });
        std::size_t out = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (out > 0 && list[out - 1].key == list[i].key)
                list[out - 1].layers.add(list[i].layers);
            else
                list[out++] = list[i];
        }
        list.resize(out);
    }
};

// round: number of the drawing round. wanted: draws only for these cells, in order; null: for all.
std::vector<FoundCell> draw_cells(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                                  const LayerMap& layers, std::uint64_t round,
                                  const std::vector<FoundCell>* wanted) {
    const auto is_wanted = [&](const FoundCell& cell) {
        return !wanted || std::binary_search(
                              wanted->begin(), wanted->end(), cell,
                              [](const FoundCell& a, const FoundCell& b) { return a.order() < b.order(); });
    };
    std::vector<std::vector<FoundCell>> runs(kRuns);
    tbb::parallel_for(std::size_t{0}, kRuns, [&](std::size_t run) {
        std::vector<FoundCell>& out = runs[run];
        for_each_point(mesh, keeps, grid, run, [&](const PointPlace& place) {
            // Random in proportion to area, independent of order: the smallest -ln(u) / area wins (Efraimidis
            // & Spirakis, Inf. Process. Lett. 97, 2006).
            const std::uint64_t word = mixed(round << 56 ^ (place.triangle << 24 | place.number));
            const float u = (static_cast<float>(word >> 41) + 0.5f) * 0x1p-23f;
            const float priority = -std::log(u) / place.share_m2;
            for (const bool back : {false, true}) {
                FoundCell cell;
                cell.key = place.key(back);
                cell.lowest = cell.highest = place.height(cell.key);
                cell.layer = layers.layer(cell.key, cell.lowest);
                if (!is_wanted(cell)) continue;
                cell.area_m2 = place.share_m2;
                cell.add(CellPoint{priority, static_cast<std::uint32_t>(place.triangle), place.number, back});
                append(out, cell);
            }
        });
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

// The visible points of cells: those that are open, and those in nooks.
struct OpenPoints {
    std::vector<FoundCell> free, nooks;
};

// Sorts the cells' points, each with the probability that it is visible.
OpenPoints open_points(const Mesh& mesh, const CubeGrid& grid, float above_m, const Openness& openness,
                       const std::vector<FoundCell>& cells) {
    constexpr float kNook = 0.05f, kOpenThere = 0.75f;
    OpenPoints out{cells, cells};
    tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t c) {
        const FoundCell& cell = cells[c];
        FoundCell& free = out.free[c];
        FoundCell& nook = out.nooks[c];
        free.count = nook.count = 0;
        for (const CellPoint& point : std::span(cell.best).first(static_cast<std::size_t>(cell.count))) {
            const TriangleSpread spread(mesh, point.triangle, 0.5f * grid.cube_m);
            const Vec3f normal = point.back ? -spread.normal : spread.normal;
            const Vec3f at = spread.at(spread.weights(static_cast<int>(point.point))) + above_m * normal;
            const std::uint64_t word = mixed(cell.key ^ (std::uint64_t{point.triangle} << 24 | point.point));
            const float u = static_cast<float>(word >> 40) * 0x1p-24f;
            const auto [near, far] = openness(at, normal, kNook * grid.cube_m, 0.5f * grid.cube_m);
            // A point in a corner is as visible as an open one; one that looks out of a slit is not.
            if (u >= 3 * far) continue;
            FoundCell& to = near >= kOpenThere ? free : nook;
            to.best[static_cast<std::size_t>(to.count++)] = point;
        }
    });
    return out;
}

// Adds points of some cells to those of all, up to the maximum.
void take_more(const std::vector<FoundCell>& more, const std::vector<FoundCell>& most,
               std::vector<FoundCell>& to) {
    std::size_t c = 0;
    for (const FoundCell& from : more) {
        while (to[c].order() != from.order()) ++c;
        for (int i = 0; i < from.count && to[c].count < most[c].count; ++i)
            to[c].best[static_cast<std::size_t>(to[c].count++)] = from.best[static_cast<std::size_t>(i)];
    }
}

}  // namespace

std::vector<FoundCell> find_cells(const Mesh& mesh, std::span<const std::uint8_t> keeps,
                                  const CubeGrid& grid) {
    return draw_cells(mesh, keeps, grid, LayerMap(mesh, keeps, grid), 0, nullptr);
}

void prefer_open_points(const Mesh& mesh, std::span<const std::uint8_t> keeps, const CubeGrid& grid,
                        float above_m, const Openness& openness, std::vector<FoundCell>& cells) {
    constexpr std::uint64_t kRounds = 8;
    const LayerMap layers(mesh, keeps, grid);
    OpenPoints open = open_points(mesh, grid, above_m, openness, cells);
    for (std::uint64_t round = 1; round < kRounds; ++round) {
        std::vector<FoundCell> wanted;
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (open.free[c].count < cells[c].count) wanted.push_back(cells[c]);
        if (wanted.empty()) break;
        const OpenPoints drawn =
            open_points(mesh, grid, above_m, openness, draw_cells(mesh, keeps, grid, layers, round, &wanted));
        take_more(drawn.free, cells, open.free), take_more(drawn.nooks, cells, open.nooks);
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const FoundCell& from = open.free[c].count > 0 ? open.free[c] : open.nooks[c];
        if (from.count > 0) cells[c].count = from.count, cells[c].best = from.best;
    }
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
