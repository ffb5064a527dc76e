#include "render/scene/light_nodes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "render/scene/color_bands.h"
#include "render/scene/light_cells.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

// The cells about a corner of the grid, and which corner of which cell's cube that is.
struct CornerUse {
    std::uint64_t key;  // of the cube above it in all axes
    std::uint32_t cell;
    std::uint32_t corner;  // of the cell's cube: x + 2 y + 4 z
};

std::vector<CornerUse> corners_of(std::span<const FoundCell> cells) {
    std::vector<CornerUse> uses;
    uses.reserve(8 * cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Cube cube = cube_of(cells[c].key);
        for (int i = 0; i < 8; ++i)
            uses.push_back(
                {key_of({cube.x + (i & 1), cube.y + (i >> 1 & 1), cube.z + (i >> 2)}, cells[c].key >> 45),
                 static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(i)});
    }
    std::sort(uses.begin(), uses.end(), [](const CornerUse& a, const CornerUse& b) {
        return std::tuple(a.key, a.cell) < std::tuple(b.key, b.cell);
    });
    return uses;
}

// Cells that a node stands for, in order; unused places hold kClosed.
using CellSet = std::array<std::uint32_t, 8>;

struct TextureReader {
    const Mesh& mesh;
    std::vector<MipTexture> pictures;

    explicit TextureReader(const Mesh& m) : mesh(m) {
        for (const Texture& texture : m.textures) pictures.emplace_back(Texture(texture));
    }
    Vec3f color(const TriangleSpread& spread, Vec3f w, std::uint16_t surface) const {
        const int texture = mesh.surfaces[surface].base_color_texture;
        if (texture < 0 || mesh.uvs.empty()) return {1, 1, 1};
        const auto uv = [&](std::size_t i) { return mesh.uvs[spread.corner[i].vertex]; };
        return pictures[static_cast<std::size_t>(texture)].sample(
            w.x * uv(0).x + w.y * uv(1).x + w.z * uv(2).x, w.x * uv(0).y + w.y * uv(1).y + w.z * uv(2).y, 0);
    }
};

// How far above the surface points are: as rays leave it in path_vertex.cpp, with room for the triangles' own
// rounding.
float above_of(const Mesh& mesh) {
    float greatest = 0;
    for (const Vec3f v : mesh.vertices_m)
        greatest = std::max({greatest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return 32 * std::numeric_limits<float>::epsilon() * greatest;
}

class NodeMaker {
  public:
    NodeMaker(const Mesh& mesh, const CubeGrid& grid, std::span<const FoundCell> cells)
        : mesh_(mesh), grid_(grid), cells_(cells), textures_(mesh), above_m_(above_of(mesh)) {}

    LightNode make(const CellSet& set, std::uint64_t seed) const {
        LightNode node;
        double area = 0;
        for (const std::uint32_t c : set)
            if (c != LightNodes::kClosed) area += cells_[c].area_m2;
        // Places along the cells' areas one behind the other, evenly.
        const double shift = static_cast<double>(mixed(seed) >> 11) * 0x1p-53;
        std::array<int, 8> used{};
        std::size_t k = 0;
        double passed = 0;
        Vec3f color{};
        for (int i = 0; i < LightNode::kPoints; ++i) {
            const double at = (i + shift) / LightNode::kPoints * area;
            while (k + 1 < set.size() && set[k + 1] != LightNodes::kClosed &&
                   passed + cells_[set[k]].area_m2 <= at)
                passed += cells_[set[k]].area_m2, ++k;
            const FoundCell& cell = cells_[set[k]];
            add(node, static_cast<std::size_t>(i),
                cell.best[static_cast<std::size_t>(used[k]++ % cell.count)], color);
        }
        node.color = color / static_cast<float>(LightNode::kPoints);
        Vec3f mean{};
        for (const std::uint32_t normal : node.normal) mean = mean + unpack_normal(normal);
        node.mean_normal = dot(mean, mean) > 1e-6f ? pack_normal(normalized(mean)) : node.normal[0];
        return node;
    }

  private:
    const Mesh& mesh_;
    CubeGrid grid_;
    std::span<const FoundCell> cells_;
    TextureReader textures_;
    float above_m_;

    void add(LightNode& node, std::size_t i, const CellPoint& candidate, Vec3f& color) const {
        const TriangleSpread spread(mesh_, candidate.triangle, 0.5f * grid_.cube_m);
        const Vec3f w = spread.weights(static_cast<int>(candidate.point));
        const Vec3f geometric = candidate.back ? -spread.normal : spread.normal;
        Vec3f normal = geometric;
        if (!mesh_.normals.empty()) {
            const auto at = [&](std::size_t k) { return mesh_.normals[spread.corner[k].vertex]; };
            const Vec3f smooth = w.x * at(0) + w.y * at(1) + w.z * at(2);
            if (dot(smooth, smooth) > 1e-6f) normal = normalized(smooth);
            if (dot(normal, geometric) < 0) normal = -normal;
        }
        node.surface = mesh_.surface_of_triangle[candidate.triangle];
        node.point_m[i] = spread.at(w) + above_m_ * geometric;
        node.normal[i] = pack_normal(normal);
        node.geometric[i] = pack_normal(geometric);
        color = color + textures_.color(spread, w, node.surface);
    }
};

}  // namespace

LightNodes::LightNodes(const Mesh& mesh, std::span<const std::uint8_t> keeps, std::size_t wanted,
                       const Openness& openness) {
    const MeshExtent extent = extent_of(mesh, keeps);
    if (!(extent.area_m2 > 0) || !std::isfinite(extent.area_m2)) return;
    const Vec3f size = extent.most - extent.least;
    const float min_cube_m = std::max({size.x, size.y, size.z}) / (kMaxCubes - 8);
    // Two sides; a wall that is aslant lies in half as many cubes again. Corrected by what is found.
    cube_m_ =
        std::max(min_cube_m, static_cast<float>(std::sqrt(3 * extent.area_m2 / static_cast<double>(wanted))));
    std::vector<FoundCell> cells;
    for (int attempt = 0; attempt < 4; ++attempt) {
        corner_m_ = extent.least - Vec3f{0.37f * cube_m_, 0.41f * cube_m_, 0.43f * cube_m_};
        cells = find_cells(mesh, keeps, {corner_m_, cube_m_});
        const double ratio = static_cast<double>(cells.size()) / static_cast<double>(wanted);
        if (ratio > 0.6 && ratio < 1.3) break;
        cube_m_ = std::max(min_cube_m, cube_m_ * static_cast<float>(std::sqrt(ratio)));
    }

    prefer_open_points(mesh, keeps, {corner_m_, cube_m_}, above_of(mesh), openness, cells);

    const std::vector<CornerUse> uses = corners_of(cells);
    struct Group {
        CellSet set;
        std::size_t first;  // of its uses
    };
    std::vector<Group> groups;
    for (std::size_t i = 0; i < uses.size();) {
        Group group{{}, i};
        group.set.fill(kClosed);
        std::size_t count = 0;
        for (const std::uint64_t key = uses[i].key; i < uses.size() && uses[i].key == key; ++i)
            group.set[count++] = uses[i].cell;
        groups.push_back(group);
    }
    std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
        return std::tuple(a.set, a.first) < std::tuple(b.set, b.first);
    });
    std::vector<std::array<std::uint32_t, 8>> corners(cells.size());
    std::vector<CellSet> sets;
    for (const Group& group : groups) {
        if (sets.empty() || sets.back() != group.set) sets.push_back(group.set);
        const std::uint64_t key = uses[group.first].key;
        for (std::size_t i = group.first; i < uses.size() && uses[i].key == key; ++i)
            corners[uses[i].cell][uses[i].corner] = static_cast<std::uint32_t>(sets.size() - 1);
    }
    cells_ = std::vector<Cell>(corners.begin(), corners.end());
    nodes_.resize(sets.size());
    const NodeMaker maker(mesh, {corner_m_, cube_m_}, cells);
    tbb::parallel_for(std::size_t{0}, sets.size(),
                      [&](std::size_t i) { nodes_[i] = maker.make(sets[i], i); });

    std::vector<std::uint64_t> keys;
    for (const FoundCell& cell : cells) keys.push_back(cell.key);
    index(keys);
}

void LightNodes::index(std::span<const std::uint64_t> keys) {
    slots_.assign(std::bit_ceil(2 * keys.size() + 1), {});
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        std::size_t at = mixed(keys[i]) & mask;
        while (slots_[at].key != Slot::kNone) at = (at + 1) & mask;
        slots_[at] = {keys[i], static_cast<std::uint32_t>(i), 0};
    }
}

const LightNodes::Cell* LightNodes::cell(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = mixed(key) & mask; slots_[at].key != Slot::kNone; at = (at + 1) & mask)
        if (slots_[at].key == key) return &cells_[slots_[at].cell];
    return nullptr;
}

LightNodes::Search LightNodes::begin(Vec3f point_m, const SurfaceSide& side) const {
    Search search;
    search.at = (point_m - corner_m_) / cube_m_;
    search.cube = CubeGrid{corner_m_, cube_m_}.cube(point_m);
    search.key = key_of(search.cube, kind_of(side));
    if (!slots_.empty()) __builtin_prefetch(&slots_[mixed(search.key) & (slots_.size() - 1)]);
    return search;
}

void LightNodes::open(Search& search) const {
    if (slots_.empty()) return;
    search.cell = cell(search.key);
    // The surface can cut a corner off the cube that no point fell into, and a level of detail is a little
    // beside the mesh: then the nearest of the neighbours that share a face or an edge.
    if (!search.cell) take_neighbour(search);
    if (search.cell) __builtin_prefetch(search.cell);
}

void LightNodes::take_neighbour(Search& search) const {
    float nearest = INFINITY;
    const Cube cube = search.cube;
    for (int i = 0; i < 27; ++i) {
        const Cube near{cube.x + i % 3 - 1, cube.y + i / 3 % 3 - 1, cube.z + i / 9 - 1};
        const auto beyond = [](float x, int c) {
            return std::max({static_cast<float>(c) - x, x - static_cast<float>(c + 1), 0.0f});
        };
        const Vec3f off{beyond(search.at.x, near.x), beyond(search.at.y, near.y),
                        beyond(search.at.z, near.z)};
        if (dot(off, off) >= nearest) continue;
        const Cell* candidate = cell(key_of(near, search.key >> 45));
        if (candidate) search.cell = candidate, search.cube = near, nearest = dot(off, off);
    }
}

bool LightNodes::finish(const Search& search, NodesAbout& about) const {
    about.count = 0;
    if (!search.cell) return false;
    const Cell& cell = *search.cell;
    const auto share = [](float x, int c) { return std::clamp(x - static_cast<float>(c), 0.0f, 1.0f); };
    const Vec3f t{share(search.at.x, search.cube.x), share(search.at.y, search.cube.y),
                  share(search.at.z, search.cube.z)};
    const std::array<float, 2> x{1 - t.x, t.x}, y{1 - t.y, t.y}, z{1 - t.z, t.z};
    std::array<float, Cell::kNone + 1> weight{};
    for (std::size_t i = 0; i < 8; ++i) weight[cell.corner(i)] += x[i & 1] * y[i >> 1 & 1] * z[i >> 2];
    float sum = 0;
    for (std::size_t i = 0; i < cell.count; ++i) sum += weight[i];
    if (!(sum > 0)) return true;
    about.count = cell.count;
    for (std::size_t i = 0; i < cell.count; ++i)
        about.node[i] = cell.node[i], about.weight[i] = weight[i] / sum;
    return true;
}

LightNodes::Cell::Cell(const std::array<std::uint32_t, 8>& of_corner) {
    for (std::size_t i = 0; i < of_corner.size(); ++i) {
        unsigned place = kNone;
        if (of_corner[i] != kClosed) {
            place = static_cast<unsigned>(std::find(node.begin(), node.begin() + count, of_corner[i]) -
                                          node.begin());
            if (place == count) node[count++] = of_corner[i];
        }
        corners |= place << (4 * i);
    }
}

void LightNodes::keep(std::span<const std::uint32_t> new_number) {
    std::vector<LightNode> kept;
    for (const std::uint32_t number : new_number)
        if (number != kClosed) kept.emplace_back();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (new_number[i] != kClosed) kept[new_number[i]] = nodes_[i];
    nodes_ = std::move(kept);
    for (Cell& cell : cells_) {
        std::array<std::uint32_t, 8> of_corner;
        for (std::size_t i = 0; i < of_corner.size(); ++i)
            of_corner[i] = cell.corner(i) == Cell::kNone ? kClosed : new_number[cell.node[cell.corner(i)]];
        cell = Cell(of_corner);
    }
}

std::size_t LightNodes::bytes() const {
    return slots_.size() * sizeof(Slot) + cells_.size() * sizeof(Cell) + nodes_.size() * sizeof(LightNode);
}

bool LightNodes::is_whole() const {
    if (!(cube_m_ > 0) || (!slots_.empty() && !std::has_single_bit(slots_.size()))) return false;
    std::size_t used = 0;
    for (const Slot& slot : slots_) {
        if (slot.key == Slot::kNone) continue;
        if (slot.cell >= cells_.size()) return false;
        ++used;
    }
    if (!slots_.empty() && used == slots_.size()) return false;  // a search would not end
    for (const Cell& cell : cells_) {
        if (cell.count > 8) return false;
        for (std::size_t i = 0; i < 8; ++i)
            if (cell.corner(i) != Cell::kNone && cell.corner(i) >= cell.count) return false;
        for (std::size_t i = 0; i < cell.count; ++i)
            if (cell.node[i] >= nodes_.size()) return false;
    }
    return true;
}

}  // namespace hilcam
