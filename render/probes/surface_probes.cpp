#include "render/probes/surface_probes.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "render/probes/probe_cells.h"
#include "render/probes/probe_maker.h"
#include "render/vocabulary/mixed_bits.h"

namespace hilcam {
namespace {

// The cells around a corner of the grid, and which corner of each cell's cube it is.
struct CornerUse {
    std::uint64_t key;        // key of the cube above it in all axes
    std::uint32_t layer = 0;  // number among the layers around the corner
    std::uint32_t cell;
    std::uint32_t corner;  // corner of the cell's cube: x + 2 y + 4 z

    bool together(const CornerUse& other) const { return key == other.key && layer == other.layer; }
};

// Numbers the layers around a corner, given its cells. Cells that continue from cube to cube are one layer.
void number_layers(std::span<const FoundCell> cells, std::span<CornerUse> about) {
    std::sort(about.begin(), about.end(), [&](const CornerUse& a, const CornerUse& b) {
        return std::tuple(cells[a.cell].lowest, a.cell) < std::tuple(cells[b.cell].lowest, b.cell);
    });
    float highest = cells[about.front().cell].highest;
    std::uint32_t layer = 0;
    for (CornerUse& use : about) {
        if (cells[use.cell].lowest > highest + Layers::kApart) ++layer;
        highest = std::max(highest, cells[use.cell].highest);
        use.layer = layer;
    }
}

std::vector<CornerUse> corners_of(std::span<const FoundCell> cells) {
    std::vector<CornerUse> uses;
    uses.reserve(8 * cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Cube cube = cube_of(cells[c].key);
        for (int i = 0; i < 8; ++i)
            uses.push_back(
                {key_of({cube.x + (i & 1), cube.y + (i >> 1 & 1), cube.z + (i >> 2)}, kind_in(cells[c].key)),
                 0, static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(i)});
    }
    const auto in_order = [](const CornerUse& a, const CornerUse& b) {
        return std::tuple(a.key, a.layer, a.cell) < std::tuple(b.key, b.layer, b.cell);
    };
    std::sort(uses.begin(), uses.end(), in_order);
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].key == uses[first].key) ++last;
        const std::span<CornerUse> about = std::span(uses).subspan(first, last - first);
        number_layers(cells, about);
        std::sort(about.begin(), about.end(), in_order);
    }
    return uses;
}

}  // namespace

SurfaceProbes::SurfaceProbes(const Mesh& mesh, std::span<const std::uint8_t> keeps, std::size_t wanted,
                             const Openness& openness, const Sight& sight) {
    const MeshExtent extent = extent_of(mesh, keeps);
    if (!(extent.area_m2 > 0) || !std::isfinite(extent.area_m2)) return;
    const Vec3f size = extent.most - extent.least;
    const float min_cube_m = std::max({size.x, size.y, size.z}) / (kMaxCubes - 8);
    // Two sides; an oblique wall occupies half as many cubes again. Corrected by the number that is found.
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

    prefer_open_points(mesh, keeps, {corner_m_, cube_m_}, points_above_m(mesh), openness, cells);

    const std::vector<CornerUse> uses = corners_of(cells);
    struct Group {
        CellSet set;
        std::size_t first;  // number of the first of its uses
    };
    std::vector<Group> groups;
    for (std::size_t i = 0; i < uses.size();) {
        Group group{{}, i};
        group.set.fill(kClosed);
        std::size_t count = 0;
        // A wall may have more than eight cells around a corner if a third one joins it; eight are enough.
        for (const CornerUse& use = uses[i]; i < uses.size() && uses[i].together(use); ++i)
            if (count < group.set.size()) group.set[count++] = uses[i].cell;
        groups.push_back(group);
    }
    std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
        return std::tuple(a.set, a.first) < std::tuple(b.set, b.first);
    });
    std::vector<std::array<std::uint32_t, 8>> corners(cells.size());
    std::vector<CellSet> sets;
    for (const Group& group : groups) {
        if (sets.empty() || sets.back() != group.set) sets.push_back(group.set);
        const CornerUse& use = uses[group.first];
        for (std::size_t i = group.first; i < uses.size() && uses[i].together(use); ++i)
            corners[uses[i].cell][uses[i].corner] = static_cast<std::uint32_t>(sets.size() - 1);
    }
    cells_.resize(cells.size());
    make_probes(sets, ProbeMaker(mesh, {corner_m_, cube_m_}, cells, sight));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        take(corners[i], cells_[i]);
        cells_[i].lowest = cells[i].lowest, cells_[i].highest = cells[i].highest;
    }

    std::vector<std::uint64_t> keys;
    keys.reserve(cells.size());
    for (const FoundCell& cell : cells) keys.push_back(cell.key);
    index(keys);
}

void SurfaceProbes::make_probes(std::span<const CellSet> sets, const ProbeMaker& maker) {
    std::vector<MadeProbe> made(sets.size());
    tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t i) { made[i] = maker.make(sets[i], i); });
    for (const MadeProbe& one : made) probes_.push_back(one.probe);
    for (std::size_t i = 0; i < made.size(); ++i) {
        if (!made[i].division) continue;
        pairs_.push_back(
            {*made[i].division, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(probes_.size())});
        probes_.push_back(made[i].above);
    }
}

// Gives a cell the probes of its corners.
void SurfaceProbes::take(const std::array<std::uint32_t, 8>& of_corner, Cell& cell) const {
    cell.take(of_corner);
    cell.divided = 0;
    for (std::size_t i = 0; i < cell.count; ++i)
        if (pair(cell.probe[i])) cell.divided = static_cast<std::uint16_t>(cell.divided | 1u << i);
}

// Returns the pair that a probe belongs to; null: none.
const SurfaceProbes::Pair* SurfaceProbes::pair(std::uint32_t probe) const {
    const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), probe,
                                     [](const Pair& p, std::uint32_t name) { return p.name() < name; });
    return at != pairs_.end() && at->name() == probe ? &*at : nullptr;
}

void SurfaceProbes::index(std::span<const std::uint64_t> keys) {
    slots_.assign(std::bit_ceil(2 * keys.size() + 1), {});
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0, first = 0; i < keys.size(); first = i) {
        while (i < keys.size() && keys[i] == keys[first]) ++i;
        std::size_t at = mixed(keys[first]) & mask;
        while (slots_[at].key != Slot::kNone) at = (at + 1) & mask;
        slots_[at] = {keys[first], static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(i - first)};
    }
}

const SurfaceProbes::Slot* SurfaceProbes::slot(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t at = mixed(key) & mask; slots_[at].key != Slot::kNone; at = (at + 1) & mask)
        if (slots_[at].key == key) return &slots_[at];
    return nullptr;
}

// Returns the layer nearest to a place.
const SurfaceProbes::Cell* SurfaceProbes::cell(const Slot& slot, Vec3f at) const {
    const Cell* best = &cells_[slot.cell];
    if (slot.layers == 1) return best;
    const float height = height_of(kind_in(slot.key), at);
    for (std::uint32_t i = 1; i < slot.layers; ++i)
        if (cells_[slot.cell + i].off(height) < best->off(height)) best = &cells_[slot.cell + i];
    return best;
}

SurfaceProbes::Search SurfaceProbes::begin(Vec3f point_m, const SurfaceSide& side) const {
    Search search;
    search.at = (point_m - corner_m_) / cube_m_;
    search.cube = CubeGrid{corner_m_, cube_m_}.cube(point_m);
    search.key = key_of(search.cube, kind_of(side));
    if (!slots_.empty()) __builtin_prefetch(&slots_[mixed(search.key) & (slots_.size() - 1)]);
    return search;
}

void SurfaceProbes::open(Search& search) const {
    if (slots_.empty()) return;
    if (const Slot* found = slot(search.key)) search.cell = cell(*found, search.at);
    // The surface may cut a corner off a cube that no point has hit, and a level of detail may be slightly
    // beside the mesh. Then the nearest neighbour with a common face or edge is used.
    if (!search.cell) take_neighbour(search);
    if (!search.cell) return;
    // Half of them span two cache lines.
    __builtin_prefetch(search.cell);
    __builtin_prefetch(reinterpret_cast<const std::byte*>(search.cell + 1) - 1);
}

void SurfaceProbes::take_neighbour(Search& search) const {
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
        const Slot* found = slot(key_of(near, kind_in(search.key)));
        if (found) search.cell = cell(*found, search.at), search.cube = near, nearest = dot(off, off);
    }
}

bool SurfaceProbes::finish(const Search& search, ProbeWeights& about) const {
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
    std::size_t count = 0;
    for (std::size_t i = 0; i < cell.count; ++i) {
        const bool divided = (static_cast<unsigned>(cell.divided) >> i & 1u) != 0;
        const std::uint32_t probe = divided ? on_side(*pair(cell.probe[i]), search.at) : cell.probe[i];
        if (probe == kClosed) continue;
        about.probe[count] = probe, about.weight[count++] = weight[i];
        sum += weight[i];
    }
    if (!(sum > 0)) return true;
    about.count = count;
    for (std::size_t i = 0; i < count; ++i) about.weight[i] /= sum;
    return true;
}

// Returns the probe of a pair for a place; at: in cubes.
std::uint32_t SurfaceProbes::on_side(const Pair& pair, Vec3f at) const {
    return pair.division.is_above(corner_m_ + cube_m_ * at) ? pair.above : pair.below;
}

void SurfaceProbes::Cell::take(const std::array<std::uint32_t, 8>& of_corner) {
    count = 0, corners = 0;
    for (std::size_t i = 0; i < of_corner.size(); ++i) {
        unsigned place = kNone;
        if (of_corner[i] != kClosed) {
            place = static_cast<unsigned>(std::find(probe.begin(), probe.begin() + count, of_corner[i]) -
                                          probe.begin());
            if (place == count) probe[count++] = of_corner[i];
        }
        corners |= place << (4 * i);
    }
}

void SurfaceProbes::keep(std::span<const std::uint32_t> new_number) {
    std::vector<SurfaceProbe> kept;
    for (const std::uint32_t number : new_number)
        if (number != kClosed) kept.emplace_back();
    for (std::size_t i = 0; i < probes_.size(); ++i)
        if (new_number[i] != kClosed) kept[new_number[i]] = probes_[i];
    probes_ = std::move(kept);
    const auto number = [&](std::uint32_t old) { return old == kClosed ? kClosed : new_number[old]; };
    std::vector<Pair> pairs;
    for (const Pair& p : pairs_) pairs.push_back({p.division, number(p.below), number(p.above)});
    std::vector<std::array<std::uint32_t, 8>> corners(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c)
        for (std::size_t i = 0; i < corners[c].size(); ++i) {
            const unsigned place = cells_[c].corner(i);
            const std::uint32_t old = place == Cell::kNone ? kClosed : cells_[c].probe[place];
            const Pair* const one = old == kClosed ? nullptr : pair(old);
            corners[c][i] = one ? pairs[static_cast<std::size_t>(one - pairs_.data())].name() : number(old);
        }
    std::erase_if(pairs, [](const Pair& p) { return p.name() == kClosed; });
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.name() < b.name(); });
    pairs_ = std::move(pairs);
    for (std::size_t c = 0; c < cells_.size(); ++c) take(corners[c], cells_[c]);
}

void SurfaceProbes::scale(float factor) {
    if (factor == 1) return;
    corner_m_ = factor * corner_m_;
    cube_m_ *= factor;
    for (SurfaceProbe& probe : probes_)
        for (Vec3f& point_m : probe.point_m) point_m = factor * point_m;
    for (Pair& one : pairs_) one.division.offset_m *= factor;
}

std::size_t SurfaceProbes::bytes() const {
    return slots_.size() * sizeof(Slot) + cells_.size() * sizeof(Cell) +
           probes_.size() * sizeof(SurfaceProbe) + pairs_.size() * sizeof(Pair);
}

// True when most of a probe's points are on one side.
bool SurfaceProbes::lies(std::uint32_t probe, const Pair& pair, bool above) const {
    int here = 0;
    for (const Vec3f point_m : probes_[probe].point_m) here += pair.division.is_above(point_m) == above;
    return 2 * here > SurfaceProbe::kPoints;
}

ProbeNeighbours SurfaceProbes::neighbours() const {
    struct Part {
        std::uint32_t probe;
        const Pair* of;  // null: it is whole
    };
    const auto parts_of = [&](std::uint32_t name, std::vector<Part>& out) {
        const Pair* const one = pair(name);
        if (!one) return out.push_back({name, nullptr});
        for (const std::uint32_t probe : {one->below, one->above})
            if (probe != kClosed) out.push_back({probe, one});
    };
    // A part of a divided probe has neighbours only on its own side.
    const auto on_side_of = [&](const Part& a, const Part& b) {
        return !a.of || lies(b.probe, *a.of, a.probe == a.of->above);
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::vector<Part> parts;
    for (const Cell& cell : cells_) {
        parts.clear();
        for (std::size_t i = 0; i < cell.count; ++i) parts_of(cell.probe[i], parts);
        for (const Part& a : parts)
            for (const Part& b : parts)
                if (a.probe != b.probe && on_side_of(a, b) && on_side_of(b, a))
                    pairs.emplace_back(a.probe, b.probe);
    }
    tbb::parallel_sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    ProbeNeighbours out;
    out.first.assign(probes_.size() + 1, 0);
    for (const auto& [from, to] : pairs) ++out.first[from + 1], out.probe.push_back(to);
    for (std::size_t n = 0; n < probes_.size(); ++n) out.first[n + 1] += out.first[n];
    return out;
}

bool SurfaceProbes::is_whole() const {
    if (!(cube_m_ > 0) || (!slots_.empty() && !std::has_single_bit(slots_.size()))) return false;
    std::size_t used = 0;
    for (const Slot& slot : slots_) {
        if (slot.key == Slot::kNone) continue;
        if (slot.layers == 0 || slot.cell >= cells_.size() || slot.layers > cells_.size() - slot.cell)
            return false;
        ++used;
    }
    if (!slots_.empty() && used == slots_.size()) return false;  // a search would not end
    const auto is_probe = [&](std::uint32_t n) { return n == kClosed || n < probes_.size(); };
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        if (!is_probe(pairs_[i].below) || !is_probe(pairs_[i].above) || pairs_[i].name() == kClosed ||
            (i > 0 && pairs_[i - 1].name() >= pairs_[i].name()))
            return false;
    for (const Cell& cell : cells_) {
        if (cell.count > 8) return false;
        for (std::size_t i = 0; i < 8; ++i)
            if (cell.corner(i) != Cell::kNone && cell.corner(i) >= cell.count) return false;
        for (std::size_t i = 0; i < cell.count; ++i) {
            const bool divided = (static_cast<unsigned>(cell.divided) >> i & 1u) != 0;
            if (cell.probe[i] >= probes_.size() || divided != (pair(cell.probe[i]) != nullptr)) return false;
        }
    }
    return true;
}

}  // namespace hilcam
