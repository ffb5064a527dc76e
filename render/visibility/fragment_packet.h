#pragma once
// Finds where rays through sixteen fragments of one object meet their triangles, and how the surface lies
// there: that which find_surface_frame() and a ray's hit tell of one, for all at once and to the same precision.
// Compiled for several widths of vectors that give the same results. Loop, any thread.

#include <array>
#include <cstdint>

#include "render/scene/surface.h"
#include "render/visibility/visibility_raster.h"

namespace hilcam {

struct alignas(64) FragmentPacket {
    static constexpr std::size_t kSize = 16;
    using Floats = std::array<float, kSize>;
    struct Vectors {
        Floats x, y, z;
        Vec3f at(std::size_t i) const { return {x[i], y[i], z[i]}; }
        void set(std::size_t i, Vec3f v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
    };
    // These are the inputs; those beyond count are worked on, too, and must hold triangles.
    std::array<std::uint32_t, kSize> triangle{};
    Vectors dir;     // world axes, of any length
    Vectors origin;  // world axes, from the body's origin [m]
    // Out.
    Floats distance, u, v;                // those of a HitPacket
    Vectors body_normal;                  // geometric, body axes, not unit
    Vectors geometric, normal, view_dir;  // those of a vertex: world axes, unit, towards the viewer
    Floats turn;                          // greatest distance of two corners' normals, squared; 0: it is flat
    Floats height;                        // the triangle's least, squared [m^2]
    std::array<std::uint32_t, kSize> back;  // nonzero: seen from behind, as the triangle's own normal has it

    std::size_t count = 0;  // last: everything else fills whole cache lines
};

struct FragmentMesh {
    const Vec3f* vertices_m;
    const TriangleCorners* corners;
    const PackedTriangle* surfaces;
    Mat3f world_from_body;
};
void find_surface_frames(const FragmentMesh& mesh, FragmentPacket& packet);

}  // namespace hilcam
