#pragma once
// Shades sixteen places of sunlit ground: where camera rays meet their triangles, the surface frames there,
// and the sunlight that they reflect. The result equals that of make_shading_point() and add_sunlight() to
// single precision. Compiled for several vector widths, which give the same results. Loop, any thread.

#include <array>
#include <cstdint>

#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"

namespace hilcam {

struct alignas(64) GroundPacket {
    static constexpr std::size_t kSize = kPacketSize;
    using Floats = std::array<float, kSize>;
    struct Vectors {
        Floats x, y, z;
        Vec3f at(std::size_t i) const { return {x[i], y[i], z[i]}; }
    };
    // Inputs. Axes are the body's.
    std::array<std::uint32_t, kSize> triangle;
    Vectors dir;  // directions of rays from the camera, any length
    // Outputs.
    Floats u, v;                  // barycentric: corner 1, corner 2
    Vectors geometric;            // normals on the viewer's side, any length
    Floats no, ni, io;            // cosines for a BRDF; ni is 0 if the Sun is below the ground
    std::array<Floats, 3> color;  // factors on the base, linear red, green, blue; 1 if the mesh has none
    std::array<SunVisibility, kSize> sun;  // known for the mesh
};

// The data that all packets of a frame share.
struct GroundInFrame {
    MeshView mesh;
    const ObjectSurfaces* surfaces = nullptr;
    Vec3f camera_m, sun_dir;  // body axes, from the body's origin
};
void find_ground(const GroundInFrame& frame, GroundPacket& packet);

// The part of Hapke's law without slopes that depends on the wavelength, for a whole packet.
struct alignas(64) HapkePacket {
    GroundPacket::Floats phase, factor;  // see HapkeGeometry
    GroundPacket::Floats log0, log1;     // ln((1 + x) / x) of both cosines
};
void find_hapke(const HapkeParameters& parameters, const GroundPacket& packet, HapkePacket& out);
// scale: factor on the reflected light; albedo: of single scattering. Returns scale f cos i.
void reflect_hapke(const HapkePacket& hapke, const GroundPacket& packet, float scale,
                   const GroundPacket::Floats& albedo, GroundPacket::Floats& out);

}  // namespace hilcam
