#pragma once
// Keys of the cells that a surface is divided into (surface_probes.h): 14 bits for each coordinate of the
// cube, six for the facing direction, one for the side, twelve for the surface. Parallel walls of one kind in
// a cube are layers of one key. Inline, because it is looked up for every pixel.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A side of an object's surface; it distinguishes the cells of a cube.
struct SurfaceSide {
    Vec3f geometric_normal;  // normal of this side, body axes
    std::uint16_t surface = 0;
    bool back = false;  // the triangle's own (right-handed) normal points to the other side
};

inline constexpr int kMaxCubes = 16300;  // along an axis

struct Cube {
    int x, y, z;
};

// Returns the number (0 to 53) of the class of directions that a normal belongs to: a face of a cube, and a
// ninth of that face, about 30 degrees wide. So facets of crinkled foil that face a light are separate from
// those that do not.
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

// Returns a unit vector in the middle of such a class.
inline Vec3f middle_of_way(unsigned way) {
    const unsigned face = way / 9, part = way % 9;
    constexpr float kThird = 2.0f / 3;
    const float u = kThird * (static_cast<float>(part % 3) - 1),
                v = kThird * (static_cast<float>(part / 3) - 1);
    const float most = face % 2 == 0 ? 1.0f : -1.0f;
    switch (face / 2) {
        case 0:
            return normalized(Vec3f{most, u, v});
        case 1:
            return normalized(Vec3f{u, most, v});
        default:
            return normalized(Vec3f{u, v, most});
    }
}

inline std::uint64_t kind_of(const SurfaceSide& side) {
    return way_of(side.geometric_normal) | static_cast<std::uint64_t>(side.back) << 6 |
           static_cast<std::uint64_t>(side.surface & 0xFFFu) << 7;
}

// Returns the key of all layers of a kind in a cube. Coordinates start at -1, so that the neighbours of a
// cube have keys.
inline std::uint64_t key_of(Cube c, std::uint64_t kind) {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + 1) & 0x3FFFu; };
    return kind << 42 | part(c.z) << 28 | part(c.y) << 14 | part(c.x);
}
inline std::uint64_t kind_in(std::uint64_t key) { return key >> 42; }

inline Cube cube_of(std::uint64_t key) {
    const auto part = [key](int shift) { return static_cast<int>(key >> shift & 0x3FFF) - 1; };
    return {part(0), part(14), part(28)};
}

struct CubeGrid {
    Vec3f corner_m;
    float cube_m;

    Cube cube(Vec3f m) const {
        const auto part = [this](float x) { return std::clamp(static_cast<int>(x / cube_m), 0, kMaxCubes); };
        return {part(m.x - corner_m.x), part(m.y - corner_m.y), part(m.z - corner_m.z)};
    }
};

// Returns how far a place is along the direction that a kind faces, in cubes. at: in cubes, from the grid's
// corner.
inline float height_of(std::uint64_t kind, Vec3f at) { return dot(middle_of_way(kind & 0x3Fu), at); }

// The layers of a kind in a cube: a bit for each eighth of a cube, along the facing direction, that contains
// some of it. Layers are at least a quarter of a cube apart. A wall that leans by 20 degrees rises by less
// than that from one of its points to the next (probe_cells.h).
class Layers {
  public:
    static constexpr float kApart = 0.25f;  // cubes

    void add(float height, float middle) { bits_ |= std::uint32_t{1} << bit_of(height, middle); }
    void add(const Layers& other) { bits_ |= other.bits_; }
    unsigned count() const { return static_cast<unsigned>(std::popcount(starts())); }
    // Returns the number of the layer at this height, which must have been added.
    unsigned layer(float height, float middle) const {
        const std::uint32_t up_to = (std::uint32_t{2} << bit_of(height, middle)) - 1;
        return static_cast<unsigned>(std::popcount(starts() & up_to)) - 1;
    }

  private:
    std::uint32_t bits_ = 0;

    // middle: height of the cube's middle; everything in the cube is within one cube of it.
    static unsigned bit_of(float height, float middle) {
        return static_cast<unsigned>(std::clamp(8 * (height - middle + 1), 0.0f, 15.0f));
    }
    // Bits with two empty ones below them.
    std::uint32_t starts() const { return bits_ & ~(bits_ << 1) & ~(bits_ << 2); }
};

}  // namespace hilcam
