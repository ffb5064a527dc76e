#pragma once
// What is finer than the maps, as an interface: something that adds to the heights of places.

#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

class GroundDetail {
  public:
    virtual ~GroundDetail() = default;
    // Places about a point of the body, as a tile has them, and what is known of them.
    struct Patch {
        std::span<const Vec3d> places;  // unit vectors of the ellipsoid's normal
        std::span<double> heights_m;    // heights of the maps, and after add() with the detail
        std::span<Vec3f> colors;        // factors on the reflectance; empty where nobody asks for them
        Vec3d middle;                   // a unit vector amid the places
        double reach_rad = 0;           // angle from the middle to the farthest of them
        double spacing_m = 1;           // distance of neighbours: what is finer is left out
    };
    // Any thread.
    virtual void add(const Patch& patch) const = 0;
};

}  // namespace hilcam
