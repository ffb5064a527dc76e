#pragma once
// The triangles of a mesh that a camera far from it may see, by the direction in which it stands: potentially visible sets (Airey,
// Rohlf & Brooks, Symposium on Interactive 3D Graphics 1990), of cells of directions.
//
// A cell's set is what pictures of the mesh show from several directions in the cell and on its border. The approximation: what is
// seen from between these alone, or between the pictures' samples, is not in it, and a sample that meets it sees what lies behind.
//
// Not modelled: cameras so near that the directions to the parts of the mesh differ, and pictures almost as fine as those (serves()).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/embree_scene.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The triangles of a mesh that may be seen, as a mesh of its own.
struct PotentiallyVisibleSet {
    std::vector<Vec3f> vertices_m;
    std::vector<TriangleCorners> triangles;
    std::vector<std::uint32_t> ids;  // by triangle the one of the whole mesh that it stands for
};

class PotentiallyVisibleSets {
  public:
    // groups: ObjectSurfaces::coplanar_groups, or none. Neither they nor the mesh are needed afterwards. The same for any number
    // of threads. Owner thread; some seconds of the processor for 5000 triangles.
    PotentiallyVisibleSets(const MeshView& mesh, double radius_m,
                           std::span<const std::uint32_t> coplanar_groups);

    // True where they hold for a camera at this distance whose samples are so far apart. Loop.
    bool serves(double distance_m, double sample_rad) const;
    // Returns what may be seen from this direction; body axes, of any length. Loop.
    const PotentiallyVisibleSet& from(Vec3d dir) const;

  private:
    double radius_m_;
    std::vector<PotentiallyVisibleSet> sets_;  // by cell
};

}  // namespace hilcam
