#pragma once
// The triangles of a mesh that a distant camera may see, by direction: potentially visible sets (Airey, Rohlf
// & Brooks, Symposium on Interactive 3D Graphics 1990) for cells of directions.
//
// The set of a cell contains what pictures of the mesh show from several directions inside the cell and on
// its border. Approximation: what is visible only between these directions, or between the pictures' samples,
// is missing, and a sample that should see it sees what is behind it.
//
// Not for cameras so near that directions to parts of the mesh differ, nor for pictures almost as fine as
// those that made the sets (serves()).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/embree_scene.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The triangles that may be visible, as a mesh of its own.
struct PotentiallyVisibleSet {
    std::vector<Vec3f> vertices_m;
    std::vector<TriangleCorners> triangles;
    std::vector<std::uint32_t> ids;  // for each triangle, its number in the whole mesh
};

class PotentiallyVisibleSets {
  public:
    // groups: ObjectSurfaces::coplanar_groups, or empty. Neither they nor the mesh are needed afterwards. The
    // result does not depend on the number of threads. Owner thread; takes some processor seconds for 5000
    // triangles.
    PotentiallyVisibleSets(const MeshView& mesh, double radius_m,
                           std::span<const std::uint32_t> coplanar_groups);

    // True when the sets are valid for a camera at this distance with this angle between samples. Loop.
    bool serves(double distance_m, double sample_rad) const;
    // Returns the set for a direction towards the camera; body axes, any length. Loop.
    const PotentiallyVisibleSet& from(Vec3d dir) const;

  private:
    double radius_m_;
    std::vector<PotentiallyVisibleSet> sets_;  // by cell
};

}  // namespace hilcam
