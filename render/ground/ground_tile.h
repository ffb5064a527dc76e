#pragma once
// A square of a body's ground: 32 x 32 quadrilaterals on a face of the cube (cube_sphere.h), at one of the levels in which
// the face is cut into 2^level x 2^level of them. Each vertex is kept twice: as the level has it, and where it lies
// on the ground of the level above, so that a mesh can go from one to the other without a step (continuous levels of
// detail; Strugar, J. Graphics, GPU and Game Tools 14(4), 57, 2009).
//
// The ground is worked out at texels, four on an edge of a quadrilateral: they have the normals that it is shaded with
// (ground_normals.h), and a vertex is their weighted mean about it.

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

// Texels with a border about what is used, and each fourth of them with a border of one more: the nodes.
struct GroundTexels {
    static constexpr int kBorder = GroundNormals::kTexels;
    GroundTileKey key;
    int quads = 0;
    double texel_m = 1;
    bool by_nodes = false;  // the maps are smooth between the nodes
    std::vector<Vec3d> places, node_places;
    std::vector<double> heights_m, node_heights_m;
    std::vector<Vec3f> colors, node_colors;
    std::vector<HapkeParameters> hapke;  // at the vertices; empty where no map has them

    int side() const { return quads * GroundNormals::kTexels + 1 + 2 * kBorder; }
    int nodes() const { return quads + 5; }
};

// A sketch of a tile has half the vertices each way, and no normals at texels: it says where the tile is, and is enough where the camera
// does not look.
struct GroundTile {
    static constexpr int kQuads = GroundNormals::kQuads, kSketchQuads = kQuads / 2;  // along an edge
    static constexpr int kSide = kQuads + 1;

    struct Look {
        Vec3f point_m;  // about the middle, body axes
        Vec3f normal;
        Vec3f color;  // factor on the reflectance
    };
    int quads = kQuads;   // along an edge
    Vec3d middle_m;       // body axes
    double radius_m = 0;  // radius about the middle that holds all
    std::vector<Look> own, above;
    std::vector<HapkeParameters> own_hapke, above_hapke;  // empty where no map has them
    std::shared_ptr<const GroundNormals::Grid> own_normals, above_normals;
    std::uint64_t used = 0;  // number of the mesh that used it last
    // A sketch is made of these, which are its tile's of the level above; null: they have been let go of.
    std::shared_ptr<const GroundTexels> texels;

    static constexpr std::size_t kHapkeBytes = 2 * sizeof(HapkeParameters) * kSide * kSide;
    static constexpr std::size_t kSketchBytes = 2 * sizeof(Look) * (kSketchQuads + 1) * (kSketchQuads + 1);
    static constexpr std::size_t kBytes =
        2 * sizeof(Look) * kSide * kSide +
        sizeof(std::uint32_t) * (GroundNormals::kSide * GroundNormals::kSide +
                                 GroundNormals::kHalfSide * GroundNormals::kHalfSide);
};

// Makes tiles; the same key always gives the same tile, bit by bit.
class GroundTileMaker {
  public:
    // All must outlive this. One thread at a time.
    // hapke: the material's own parameters, where maps have others by place.
    GroundTileMaker(GroundSurface& surface, std::span<const std::unique_ptr<const GroundDetail>> details,
                    const HapkeParameters& hapke = {})
        : surface_(surface), details_(details), hapke_(hapke) {}

    // Makes sketches of tiles, or tiles that have been sketched, on all of oneTBB's threads. sketches: one for each tile; with texels
    // they save a fifth of the work.
    std::vector<std::unique_ptr<GroundTile>> sketch(std::span<const GroundTileKey> keys);
    std::vector<std::unique_ptr<GroundTile>> make(std::span<const GroundTileKey> keys,
                                                  std::span<const GroundTile* const> sketches);
    // Returns the distance of neighbouring vertices at a level [m], about.
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
        std::shared_ptr<GroundTexels> above_laid;  // where above is still to be made of it
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
