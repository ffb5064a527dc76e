#pragma once
// A square plate in waves of 0.1 m both ways, as foil has them; flat with an amplitude of zero. One surface,
// faces +z.

#include <cmath>
#include <cstdint>

#include "render/vocabulary/mesh.h"

namespace hilcam {

inline Mesh wavy_plate(int steps, double from_m, double to_m, double amplitude_m) {
    constexpr double k_rad_m = 60;
    Mesh mesh;
    mesh.surfaces.resize(1);
    for (int j = 0; j <= steps; ++j)
        for (int i = 0; i <= steps; ++i) {
            const double x = from_m + (to_m - from_m) * i / steps, y = from_m + (to_m - from_m) * j / steps;
            const double z = amplitude_m * (std::sin(k_rad_m * x) + std::sin(k_rad_m * y + x));
            mesh.vertices_m.push_back(to_float({x, y, z}));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace hilcam
