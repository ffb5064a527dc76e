#pragma once
// The ground of a whole body, as fine as the camera needs it: quadtrees of tiles on a cube's six faces. A
// tile is divided into four while its vertices are more than `edge_px` pixels apart at its point nearest to
// the camera. With distance, each vertex moves from its own level's ground to that of the next coarser level,
// and arrives where the next coarser tile begins. So meshes join without gaps, and nothing jumps as the
// camera approaches.
//
// Outside the field and behind the horizon, where only shadows matter, tiles are kOutside times coarser and
// have half as many vertices in each direction; skirts on their edges stop light at the transition. If there
// are too many triangles, all become larger, up to a 128th of the distance. Beyond that meshes would not
// join, so the number may exceed the limit.
//
// Terrain axes are the body's own, from its centre. Not modelled: overhangs.

#include <array>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

#include "render/ground/ground_tile.h"
#include "render/scene/terrain.h"

namespace hilcam {

struct GlobeSettings {
    std::size_t max_bytes = std::size_t{512} << 20;  // memory for maps and tiles
    double finest_m = 0.01;                          // approximate smallest distance between vertices
    HapkeParameters hapke{};                         // the material's; maps may replace them by place
};

class GlobeTerrain final : public Terrain {
  public:
    GlobeTerrain(const Figure& figure, std::vector<GroundMap> maps,
                 std::vector<std::unique_ptr<const GroundDetail>> details, const GlobeSettings& settings);

    TerrainMesh mesh(const TerrainView& view) override;
    bool make_ahead(const TerrainView& view) override;
    bool depends_on_boresight() const override { return true; }
    Vec3d up_at(Vec3d point_m) const override;
    std::optional<double> height_above_ground_m(Vec3d) const override { return {}; }

    // Returns the memory of maps and tiles. Same thread as mesh().
    std::size_t kept_bytes() const {
        return surface_.pages().bytes() + tiles_.size() * tile_bytes() + sketches_.size() * sketch_bytes();
    }

  private:
    static constexpr double kOutside = 32;
    struct Leaf {
        GroundTileKey key;
        const GroundTile* tile;
        bool outside;  // outside the field or behind the horizon
    };
    GroundSurface surface_;
    std::vector<std::unique_ptr<const GroundDetail>> details_;
    GroundTileMaker maker_;
    std::size_t max_tiles_, max_sketches_;
    int finest_level_;
    std::uint64_t mesh_number_ = 0;
    using Tiles = std::unordered_map<std::uint64_t, std::unique_ptr<GroundTile>>;
    Tiles tiles_, sketches_;

    std::size_t sketch_bytes() const {
        return GroundTile::kSketchBytes + (surface_.has_hapke() ? GroundTile::kHapkeBytes / 4 : 0);
    }
    std::size_t tile_bytes() const {
        return GroundTile::kBytes + (surface_.has_hapke() ? GroundTile::kHapkeBytes : 0);
    }
    // Sketches that still have their texels, oldest first.
    std::deque<GroundTile*> with_texels_;

    // The outcome of a selection.
    enum class Selected { kAll, kTooManyTriangles, kNotYet };
    std::size_t may_make_ = kAnyNumber;  // tiles; at zero a selection stops with kNotYet
    static constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

    bool require_sketches(std::span<const GroundTileKey> keys);
    bool require_tiles(std::span<const GroundTileKey> keys);
    std::vector<GroundTileKey> to_be_made(std::span<const GroundTileKey> keys, const Tiles& of, bool& all);
    void mark_used(std::span<const GroundTileKey> keys, const Tiles& of) const;
    void keep_texels(std::size_t most);
    bool find_leaves(const TerrainView& view, double& edges, std::vector<Leaf>& leaves);
    Selected select(const TerrainView& view, double edges, std::size_t max_triangles,
                    std::vector<Leaf>& leaves);
    bool is_outside(const TerrainView& view, const GroundTile& tile) const;
    static bool forget_oldest(Tiles& tiles, std::size_t most, std::uint64_t before);
    TerrainMesh assemble(const TerrainView& view, double edges, const std::vector<Leaf>& leaves) const;
    using Shares = std::array<float, GroundTile::kSide * GroundTile::kSide>;  // at a tile's vertices
    void append(const Leaf& leaf, const Shares& shares, Vec3d anchor_m, const MeshGrid& grid,
                Mesh& mesh) const;
    void find_shares(const TerrainView& view, double edges, const Leaf& leaf, Shares& shares) const;
    static std::size_t triangles_of(std::span<const Leaf> leaves);
};

}  // namespace hilcam
