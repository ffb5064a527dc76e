#pragma once
// Finds where rays through sixteen fragments of one object meet their triangles, and the surface frames
// there. It gives the same as find_surface_frame() and a traced ray, to the same precision, for sixteen at
// once. Compiled for several vector widths, which give the same results. Loop, any thread.

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
    // Inputs. Entries beyond count are processed too and must hold triangles.
    std::array<std::uint32_t, kSize> triangle{};
    Vectors dir;     // world axes, of any length
    Vectors origin;  // world axes, from the body's origin [m]
    // Outputs.
    Floats distance, u, v;                  // those of a HitPacket
    Vectors body_normal;                    // geometric, body axes, not unit
    Vectors geometric, normal, view_dir;    // those of a shading point: world axes, unit, towards the viewer
    Floats turn;                            // largest squared distance between two corners' normals; 0: flat
    Floats height;                          // smallest height of the triangle, squared [m^2]
    std::array<std::uint32_t, kSize> back;  // nonzero: seen from behind, by the triangle's own normal

    std::size_t count = 0;  // last, so that everything else fills whole cache lines
};

struct FragmentMesh {
    const Vec3f* vertices_m;
    const TriangleCorners* corners;
    const PackedTriangle* surfaces;
    Mat3f world_from_body;
};
void find_surface_frames(const FragmentMesh& mesh, FragmentPacket& packet);

}  // namespace hilcam
