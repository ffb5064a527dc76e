#pragma once
// The spacecraft itself: a geostationary communications satellite of common proportions, all dimensions in
// metres.
//
// Body axes: +z to the Earth (antenna deck), +y along the wings, +x along the flight direction; origin in the
// middle of the bus. Bus 2.4 x 2.2 x 3.6 m, two wings of four panels, span 26.6 m, two offset dishes of 2.2
// m.

#include <cstdint>
#include <vector>

#include "tools/make_spacecraft/patch.h"

namespace spacecraft {

struct DesignOptions {
    std::size_t triangles = 3000000;  // decides whether solar cells are separate pieces
    double wing_angle_rad = 0;        // cells look along +z at 0, along +x at 90 deg
    std::uint32_t seed = 1;
};

std::vector<Patch> design(const DesignOptions& options);

}  // namespace spacecraft
