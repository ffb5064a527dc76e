#pragma once
// A square of a body's ground: 32 x 32 quadrilaterals on a face of the cube (cube_sphere.h), at a level that
// divides the face into 2^level x 2^level tiles. Each vertex is stored twice, on its own level's ground and
// on that of the next coarser level, so that a mesh can blend from one to the other (continuous levels of
// detail; Strugar, J. Graphics, GPU and Game Tools 14(4), 57, 2009).
//
// The ground is computed at texels, four along the edge of a quadrilateral. They hold the normals for shading
// (ground_normals.h); a vertex is a weighted mean of the texels around it.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/ground/ground_detail.h"
#include "render/ground/ground_surface.h"
#include "render/scene/ground_normals.h"

namespace hilcam {

struct GroundTileKey {
    int face = 0, level = 0;
    std::int32_t column = 0, row = 0;  // along the face's right and up
    friend bool operator==(const GroundTileKey& a, const GroundTileKey& b) = default;
    GroundTileKey child(int k) const { return {face, level + 1, 2 * column + k % 2, 2 * row + k / 2}; }
    // Levels are below 28.
    std::uint64_t word() const {
        return (static_cast<std::uint64_t>(face) << 61) | (static_cast<std::uint64_t>(level) << 56) |
               (static_cast<std::uint64_t>(row) << 28) | static_cast<std::uint64_t>(column);
    }
};

// The texels of a tile with a border, and the nodes: every fourth texel, with a border of one more.
struct GroundTexels {
    static constexpr int kBorder = GroundNormals::kTexels;
    GroundTileKey key;
    int quads = 0;
    double texel_m = 1;
    bool by_nodes = false;  // maps are smooth between the nodes
    std::vector<Vec3d> places, node_places;
    std::vector<double> heights_m, node_heights_m;
    std::vector<Vec3f> colors, node_colors;
    std::vector<HapkeParameters> hapke;  // at the vertices; empty if no map has them

    int side() const { return quads * GroundNormals::kTexels + 1 + 2 * kBorder; }
    int nodes() const { return quads + 5; }
};

// A sketch of a tile has half as many vertices in each direction and no normals at texels. It gives the
// tile's position, and suffices where the camera does not look.
struct GroundTile {
    static constexpr int kQuads = GroundNormals::kQuads, kSketchQuads = kQuads / 2;  // along an edge
    static constexpr int kSide = kQuads + 1;

    struct Look {
        Vec3f point_m;  // relative to the middle, body axes
        Vec3f normal;
        Vec3f color;  // factor on the reflectance
    };
    int quads = kQuads;   // along an edge
    Vec3d middle_m;       // body axes
    double radius_m = 0;  // sphere about the middle that holds everything
    std::vector<Look> own, above;
    std::vector<HapkeParameters> own_hapke, above_hapke;  // empty if no map has them
    std::shared_ptr<const GroundNormals::Grid> own_normals, above_normals;
    std::uint64_t used = 0;  // number of the last mesh that used it
    // The texels from which a sketch was made: those of its tile at the next coarser level; null: released.
    std::shared_ptr<const GroundTexels> texels;

    static constexpr std::size_t kHapkeBytes = 2 * sizeof(HapkeParameters) * kSide * kSide;
    static constexpr std::size_t kSketchBytes = 2 * sizeof(Look) * (kSketchQuads + 1) * (kSketchQuads + 1);
    static constexpr std::size_t kBytes =
        2 * sizeof(Look) * kSide * kSide +
        sizeof(std::uint32_t) * (GroundNormals::kSide * GroundNormals::kSide +
                                 GroundNormals::kHalfSide * GroundNormals::kHalfSide);
};

// Makes tiles. The same key always gives the same tile, bit by bit.
class GroundTileMaker {
  public:
    // All arguments must outlive this. hapke: the material's parameters; maps may replace them by place. One
    // thread at a time.
    GroundTileMaker(GroundSurface& surface, std::span<const std::unique_ptr<const GroundDetail>> details,
                    const HapkeParameters& hapke = {})
        : surface_(surface), details_(details), hapke_(hapke) {}

    // Make sketches of tiles, or tiles that already have sketches, on all of oneTBB's threads. sketches: one
    // for each tile; their texels, if kept, save a fifth of the work.
    std::vector<std::unique_ptr<GroundTile>> sketch(std::span<const GroundTileKey> keys);
    std::vector<std::unique_ptr<GroundTile>> make(std::span<const GroundTileKey> keys,
                                                  std::span<const GroundTile* const> sketches);
    // Returns the approximate distance of neighbouring vertices at a level [m].
    double spacing_m(int level) const;

  private:
    struct Looks {
        std::vector<GroundTile::Look> vertices;
        std::shared_ptr<const GroundNormals::Grid> normals;
    };
    GroundSurface& surface_;
    std::span<const std::unique_ptr<const GroundDetail>> details_;
    HapkeParameters hapke_;

    // A tile in the making.
    struct Making {
        std::shared_ptr<GroundTexels> own;
        std::shared_ptr<const GroundTexels> above;
        std::shared_ptr<GroundTexels> above_laid;  // if `above` still has to be made from it
    };

    std::shared_ptr<GroundTexels> lay(const GroundTileKey& key, int quads);
    std::vector<Vec3d> places_of(const GroundTexels& texels, int step, int first, int side) const;
    void add_details(GroundTexels& texels) const;
    Looks looks(const GroundTexels& texels, Vec3d middle_m, bool sketch) const;
    std::unique_ptr<GroundTile> finish(const GroundTexels& own, const GroundTexels& above) const;
    std::unique_ptr<GroundTile> make(Making& making) const;
    template <class Lay>
    std::vector<std::unique_ptr<GroundTile>> make_all(std::size_t count, const Lay& lay_one);
};

}  // namespace hilcam
