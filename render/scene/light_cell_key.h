#pragma once
// Keys of the cells that a surface is cut into (light_nodes.h): 15 bits for each coordinate of the cube, six
// for the way it faces, one for the side, twelve for the surface. Inline: looked up for every pixel.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Where on an object's surface: what tells cells of a cube apart.
struct SurfaceSide {
    Vec3f geometric_normal;  // of this side, body axes
    std::uint16_t surface = 0;
    bool back = false;  // the triangle's own normal (right-handed) points to the other side
};

inline constexpr int kMaxCubes = 32700;  // along an axis

struct Cube {
    int x, y, z;
};

// A face of a cube about the normal and a ninth of that: 30 degrees wide, about. The slopes of crinkled foil
// that face a light are others than those that face away.
inline unsigned way_of(Vec3f normal) {
    const float x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const auto ninth = [](float u, float v, float most) {
        const auto third = [most](float w) { return w < -most / 3 ? 0u : w < most / 3 ? 1u : 2u; };
        return 3 * third(v) + third(u);
    };
    if (x >= y && x >= z) return (normal.x >= 0 ? 0 : 9) + ninth(normal.y, normal.z, x);
    if (y >= z) return (normal.y >= 0 ? 18 : 27) + ninth(normal.x, normal.z, y);
    return (normal.z >= 0 ? 36 : 45) + ninth(normal.x, normal.y, z);
}

inline std::uint64_t kind_of(const SurfaceSide& side) {
    return way_of(side.geometric_normal) | static_cast<std::uint64_t>(side.back) << 6 |
           static_cast<std::uint64_t>(side.surface & 0xFFFu) << 7;
}

// Coordinates from -1 on, so that a cube's neighbours have keys.
inline std::uint64_t key_of(Cube c, std::uint64_t kind) {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + 1) & 0x7FFFu; };
    return kind << 45 | part(c.z) << 30 | part(c.y) << 15 | part(c.x);
}

inline Cube cube_of(std::uint64_t key) {
    const auto part = [key](int shift) { return static_cast<int>(key >> shift & 0x7FFF) - 1; };
    return {part(0), part(15), part(30)};
}

// Finalizer of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
inline std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

struct CubeGrid {
    Vec3f corner_m;
    float cube_m;

    Cube cube(Vec3f m) const {
        const auto part = [this](float x) { return std::clamp(static_cast<int>(x / cube_m), 0, kMaxCubes); };
        return {part(m.x - corner_m.x), part(m.y - corner_m.y), part(m.z - corner_m.z)};
    }
};

}  // namespace hilcam
