#pragma once
// The ground of a whole body, as fine as the camera sees it: tiles of a cube's six faces in quadtrees. A tile is cut into
// four while its vertices are farther apart than `edge_px` pixels where it is nearest to the camera. With its
// distance each vertex goes from its own level's ground to that of the level above, which it has reached where the next
// coarser tile begins: meshes join without gaps, and nothing steps while the camera comes nearer. Beside the field and
// behind the horizon, where only shadows come from, tiles are kOutside times coarser and have half their vertices each way; skirts hang from the tiles'
// edges, so that no light comes through where such a tile begins. Where triangles are too many, all are wider, down to a 128th
// of the distance, from which on they may be more than was asked for: wider ones would not join.
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
    std::size_t max_bytes = std::size_t{512} << 20;  // memory of maps and tiles that are kept
    double finest_m = 0.01;                          // vertices are not nearer to each other than this, about
    HapkeParameters hapke{};                         // the material's own, where maps have others by place
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

    // Returns how many bytes maps and tiles hold. The thread of mesh().
    std::size_t kept_bytes() const {
        return surface_.pages().bytes() + tiles_.size() * tile_bytes() + sketches_.size() * sketch_bytes();
    }

  private:
    static constexpr double kOutside = 32;
    struct Leaf {
        GroundTileKey key;
        const GroundTile* tile;
        bool outside;  // beside the field or behind the horizon
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
    // Sketches that still have their texels, the first ones longest.
    std::deque<GroundTile*> with_texels_;

    // Selections end so.
    enum class Selected { kAll, kTooManyTriangles, kNotYet };
    std::size_t may_make_ = kAnyNumber;  // tiles, until the selection stops as kNotYet
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
