#pragma once
// A surface as a function of (u, v) in [0, 1]^2 that can be meshed at any resolution.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/vocabulary/vec.h"

namespace spacecraft {

using hilcam::Vec3d;
using hilcam::Vec3f;

struct Patch {
    std::string part;      // node in the file
    std::string material;  // see materials.h
    // Right-handed: du x dv points outwards.
    std::function<Vec3d(double u, double v)> at;
    int min_u = 1, min_v = 1;  // pieces along u and v that keep the shape recognisable
    double detail = 0;         // share of the free triangles; 0: always the least
    double aspect = 1;         // length along u over length along v
};

// Pieces along u and v when `scale` free pieces fall on a detail of 1.
std::array<int, 2> pieces_of(const Patch& patch, double scale);
std::size_t triangles_of(const Patch& patch, double scale);
// The scale at which all patches together have nearest to `triangles` triangles.
double scale_for(const std::vector<Patch>& patches, std::size_t triangles);

struct Surface {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};
// Appends the patch's mesh; normals are smooth inside a patch and split between patches.
void append(const Patch& patch, double scale, Surface& surface);

}  // namespace spacecraft
