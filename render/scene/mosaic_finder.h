#pragma once
// Finds the mosaics (mosaic.h) of an object's mesh, and what of it they stand for.
//
// The ground is a flat part of one surface, as large as goes on from one of the largest triangles by common corners; upon it lie
// flat triangles of up to three other surfaces that lean as it does and are less than a texel above it. What has a picture, colours
// of its own, wrinkles that a level has flattened, or lets light through is not in a mosaic.

#include <memory>
#include <vector>

#include "render/scene/mosaic.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct ObjectSurfaces;

// mesh: a level of detail; error_m: its error, and texels are no finer. Owner thread.
std::vector<Mosaic> find_mosaics(const Mesh& mesh, const ObjectSurfaces& surfaces, double error_m);

// In a level of detail, the ground's largest triangle stands for all of a mosaic (ObjectSurfaces::patches), where its texels are
// no coarser than the level's error, and what lies on the ground is not shown by itself. After find_patches(). Owner thread.
void attach_mosaics(const std::shared_ptr<const std::vector<Mosaic>>& mosaics, const Mesh& mesh,
                    double error_m, ObjectSurfaces& surfaces);

}  // namespace hilcam
