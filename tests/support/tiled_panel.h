#pragma once
// A panel: a square of ground on which square tiles of another surface lie in rows, with gaps between them and half of one along the
// border. Faces +z, and begins at the origin.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/vocabulary/mesh.h"

namespace hilcam {

struct TiledPanel {
    int tiles = 20;  // in a row
    double pitch_m = 0.1, gap_m = 0.005, height_m = 0.001;

    double side_m() const { return tiles * pitch_m; }
    // The share of a way along a side, from its corner, that tiles cover.
    double covered(double from_m, double until_m) const {
        const auto to = [&](double at_m) {
            const double whole = std::floor(at_m / pitch_m), rest_m = at_m - whole * pitch_m;
            return whole * (pitch_m - gap_m) + std::clamp(rest_m - 0.5 * gap_m, 0.0, pitch_m - gap_m);
        };
        return (to(until_m) - to(from_m)) / (until_m - from_m);
    }
    Mesh mesh() const {
        Mesh out;
        out.surfaces.resize(2);
        add(out, 0, 0, 0, side_m(), 0);
        for (int j = 0; j < tiles; ++j)
            for (int i = 0; i < tiles; ++i)
                add(out, 1, i * pitch_m + 0.5 * gap_m, j * pitch_m + 0.5 * gap_m, pitch_m - gap_m, height_m);
        return out;
    }

  private:
    static void add(Mesh& mesh, std::uint16_t surface, double x, double y, double side, double z) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
        for (const Vec3d corner :
             {Vec3d{x, y, z}, Vec3d{x + side, y, z}, Vec3d{x + side, y + side, z}, Vec3d{x, y + side, z}})
            mesh.vertices_m.push_back(to_float(corner));
        for (const std::array<std::uint32_t, 3> t :
             {std::array{first, first + 1, first + 2}, std::array{first, first + 2, first + 3}})
            mesh.triangles.push_back(t), mesh.surface_of_triangle.push_back(surface);
    }
};

}  // namespace hilcam
