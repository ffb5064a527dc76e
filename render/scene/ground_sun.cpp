#include "render/scene/ground_sun.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr int kQuads = GroundNormals::kQuads, kSide = kQuads + 1;
using SeenCells = std::array<std::uint8_t, kSide * kSide>;             // 1: the vertex sees the Sun
constexpr int kCellsAcross = 4, kLanes = kCellsAcross * kCellsAcross;  // vertices that are tested together
constexpr std::uint32_t kBlock = 4;                                    // quadrilaterals on an edge of a block
constexpr float kInfinitelyFar = std::numeric_limits<float>::infinity();

// A box in the Sun's view: z towards the Sun.
struct Box {
    float x0 = kInfinitelyFar, x1 = -kInfinitelyFar, y0 = kInfinitelyFar, y1 = -kInfinitelyFar,
          z0 = kInfinitelyFar, z1 = -kInfinitelyFar;

    void grow(Vec3f p) {
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        z0 = std::min(z0, p.z), z1 = std::max(z1, p.z);
    }
    void grow(const Box& other) {
        grow(Vec3f{other.x0, other.y0, other.z0});
        grow(Vec3f{other.x1, other.y1, other.z1});
    }
    // True if something in this box may be between something in the other box and the Sun.
    bool may_shade(const Box& other) const {
        return x0 <= other.x1 && x1 >= other.x0 && y0 <= other.y1 && y1 >= other.y0 && z1 > other.z0;
    }
};

// The triangles of a tile that face away from the Sun, by blocks.
struct Shades {
    struct Block {
        Box box;
        std::size_t first, end;  // triangles
    };
    Box box;
    std::vector<Block> blocks;
    std::vector<std::array<Vec3f, 3>> triangles;
};

// A mesh in the Sun's view.
class SunView {
  public:
    SunView(const TerrainMesh& terrain, Vec3d sun_dir)
        : mesh_(terrain.mesh), grids_(terrain.grids), z_(to_float(sun_dir)) {
        const Vec3d aside = std::abs(sun_dir.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
        const Vec3d x = normalized(cross(aside, sun_dir));
        x_ = to_float(x), y_ = to_float(cross(sun_dir, x));
        points_.resize(mesh_.vertices_m.size());
        shades_.resize(grids_.size());
        tbb::parallel_for(std::size_t{0}, grids_.size(), [&](std::size_t i) {
            const std::size_t first = grids_[i].first_vertex;
            for (std::size_t k = first; k < first + MeshGrid::vertices(grids_[i].quads); ++k)
                points_[k] = seen_by_sun(mesh_.vertices_m[k]);
            find_shades(grids_[i], shades_[i]);
        });
    }

    SeenCells seen_from_tile(const MeshGrid& grid) const;

  private:
    struct alignas(64) Packet {
        std::array<float, kLanes> x, y, z;
        Box box;
    };
    struct Candidate {
        const Shades::Block* block;
        const std::array<Vec3f, 3>* triangles;  // all of its tile
    };
    const Mesh& mesh_;
    const std::vector<MeshGrid>& grids_;
    Vec3f x_, y_, z_;
    std::vector<Vec3f> points_;  // vertices in the Sun's view
    std::vector<Shades> shades_;

    Vec3f seen_by_sun(Vec3f v) const { return {dot(v, x_), dot(v, y_), dot(v, z_)}; }
    void find_shades(const MeshGrid& grid, Shades& out) const;
    std::vector<Candidate> shades_over(const Box& box) const;
    static std::uint32_t blocked(const Packet& packet, const std::array<Vec3f, 3>& triangle);
};

void SunView::find_shades(const MeshGrid& grid, Shades& out) const {
    const std::uint32_t cells = grid.quads + 2, side = cells + 1;
    const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c, Box& box) {
        if (!((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0)) return;
        out.triangles.push_back({a, b, c});
        box.grow(a), box.grow(b), box.grow(c);
    };
    for (std::uint32_t y0 = 0; y0 < cells; y0 += kBlock)
        for (std::uint32_t x0 = 0; x0 < cells; x0 += kBlock) {
            Shades::Block block{{}, out.triangles.size(), 0};
            for (std::uint32_t y = y0; y < std::min(cells, y0 + kBlock); ++y)
                for (std::uint32_t x = x0; x < std::min(cells, x0 + kBlock); ++x) {
                    const Vec3f* const at = points_.data() + grid.first_vertex + y * side + x;
                    add(at[0], at[1], at[side], block.box);
                    add(at[1], at[side + 1], at[side], block.box);
                }
            block.end = out.triangles.size();
            if (block.end == block.first) continue;
            out.blocks.push_back(block);
            out.box.grow(block.box);
        }
}

// Returns a word in which bit i is set if the triangle, which faces away from the Sun, is between vertex i
// and the Sun.
std::uint32_t SunView::blocked(const Packet& p, const std::array<Vec3f, 3>& t) {
    const auto& [a, b, c] = t;
    std::array<std::uint32_t, kLanes> over;
    for (std::size_t i = 0; i < kLanes; ++i) {
        // Twice the areas beyond the three edges. For an edge that two triangles share they differ only in
        // sign.
        const float ax = a.x - p.x[i], ay = a.y - p.y[i], bx = b.x - p.x[i], by = b.y - p.y[i],
                    cx = c.x - p.x[i], cy = c.y - p.y[i];
        const float ab = by * ax - bx * ay, bc = cy * bx - cx * by, ca = ay * cx - ax * cy;
        const float above = bc * (a.z - p.z[i]) + ca * (b.z - p.z[i]) + ab * (c.z - p.z[i]);
        over[i] = (ab <= 0) & (bc <= 0) & (ca <= 0) & (above < 0) ? 1u : 0u;
    }
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kLanes; ++i) bits |= over[i] << i;
    return bits;
}

// Returns the blocks that may be between something in a box and the Sun.
std::vector<SunView::Candidate> SunView::shades_over(const Box& box) const {
    std::vector<Candidate> out;
    for (const Shades& shades : shades_)
        if (!shades.blocks.empty() && shades.box.may_shade(box))
            for (const Shades::Block& block : shades.blocks)
                if (block.box.may_shade(box)) out.push_back({&block, shades.triangles.data()});
    return out;
}

SeenCells SunView::seen_from_tile(const MeshGrid& grid) const {
    const auto vertex = [&](int x, int y) {
        return grid.first_vertex + static_cast<std::size_t>((y + 1) * (kQuads + 3) + x + 1);
    };
    // Raised above the ground by a hundredth of an edge, so that no triangle at the vertex hides it.
    constexpr float kAbove = 0.01f;
    const float above_m = kAbove * length(mesh_.vertices_m[vertex(1, 0)] - mesh_.vertices_m[vertex(0, 0)]);
    std::array<Vec3f, kSide * kSide> starts;
    SeenCells seen;
    Box all;  // around those that face the Sun
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t v = vertex(static_cast<int>(i) % kSide, static_cast<int>(i) / kSide);
        const Vec3f normal = seen_by_sun(mesh_.normals[v]);
        starts[i] = points_[v] + above_m * normal;
        seen[i] = normal.z > 0 ? 1 : 0;
        if (seen[i]) all.grow(starts[i]);
    }
    const std::vector<Candidate> candidates = shades_over(all);
    if (candidates.empty()) return seen;
    for (int y0 = 0; y0 < kSide; y0 += kCellsAcross)
        for (int x0 = 0; x0 < kSide; x0 += kCellsAcross) {
            Packet packet;
            std::array<std::size_t, kLanes> of;  // clamped to the tile's edge
            std::uint32_t lit = 0;
            for (std::size_t i = 0; i < kLanes; ++i) {
                const int dx = static_cast<int>(i) % kCellsAcross, dy = static_cast<int>(i) / kCellsAcross;
                of[i] =
                    static_cast<std::size_t>(std::min(y0 + dy, kQuads) * kSide + std::min(x0 + dx, kQuads));
                const Vec3f p = starts[of[i]];
                packet.x[i] = p.x, packet.y[i] = p.y, packet.z[i] = p.z;
                if (!seen[of[i]]) continue;
                packet.box.grow(p);
                lit |= 1u << i;
            }
            for (const auto& [block, triangles] : candidates)
                if (lit != 0 && block->box.may_shade(packet.box))
                    for (std::size_t t = block->first; t < block->end; ++t)
                        lit &= ~blocked(packet, triangles[t]);
            for (std::size_t i = 0; i < kLanes; ++i) seen[of[i]] = static_cast<std::uint8_t>(lit >> i & 1u);
        }
    return seen;
}

// Returns the visibility of the Sun at the vertices around a quadrilateral.
SunVisibility known_of(const SeenCells& seen, int x, int y) {
    int lit = 0, all = 0;
    for (int j = std::max(0, y - 1); j <= std::min(kQuads, y + 2); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(kQuads, x + 2); ++i, ++all)
            lit += seen[static_cast<std::size_t>(j * kSide + i)];
    return lit == all ? SunVisibility::kLit : lit == 0 ? SunVisibility::kDark : SunVisibility::kAsk;
}

}  // namespace

std::vector<SunVisibility> sun_visibility(const TerrainMesh& terrain, Vec3d sun_dir) {
    std::vector<SunVisibility> known(terrain.mesh.triangles.size(), SunVisibility::kAsk);
    const SunView view(terrain, sun_dir);
    tbb::parallel_for(std::size_t{0}, terrain.normals->tiles.size(), [&](std::size_t tile) {
        const SeenCells seen = view.seen_from_tile(terrain.grids[tile]);
        SunVisibility* const at = known.data() + terrain.grids[tile].first_triangle;
        for (int y = 0; y < kQuads; ++y)
            for (int x = 0; x < kQuads; ++x) {
                const auto k = static_cast<std::size_t>(2 * (y * kQuads + x));
                at[k] = at[k + 1] = known_of(seen, x, y);
            }
    });
    return known;
}

}  // namespace hilcam
