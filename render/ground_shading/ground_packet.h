#pragma once
// Sixteen places of sunlit ground at a time: where a camera's rays meet their triangles, how the ground lies there, and what
// of the Sun's light it sends back. It is that which make_shading_point() and add_sunlight() find of one, to single precision.
// Compiled for several widths of vectors that give the same results. Loop, any thread.

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
    // These are the inputs. Axes are the body's.
    std::array<std::uint32_t, kSize> triangle;
    Vectors dir;  // directions of rays from the camera, of any length
    // Out.
    Floats u, v;        // barycentric: corner 1, corner 2
    Vectors geometric;  // normals towards the viewer, of any length
    Floats no, ni, io;  // the cosines that a BRDF asks for; ni is 0 where the Sun is below the ground
    std::array<Floats, 3> color;  // factors on the base, linear red, green, blue; 1 where the mesh has none
    std::array<SunVisibility, kSize> sun;  // the mesh's own knowledge
};

// This is what all packets of a frame share.
struct GroundInFrame {
    MeshView mesh;
    const ObjectSurfaces* surfaces = nullptr;
    Vec3f camera_m, sun_dir;  // body axes, from the body's origin
};
void find_ground(const GroundInFrame& frame, GroundPacket& packet);

// The part of Hapke's law without slopes that depends on the wavelength, for all of a packet.
struct alignas(64) HapkePacket {
    GroundPacket::Floats phase, factor;  // those of HapkeGeometry
    GroundPacket::Floats log0, log1;     // ln((1 + x) / x) of both cosines
};
void find_hapke(const HapkeParameters& parameters, const GroundPacket& packet, HapkePacket& out);
// scale: factor on what is reflected; albedo: of single scattering. Gives scale f cos i.
void reflect_hapke(const HapkePacket& hapke, const GroundPacket& packet, float scale,
                   const GroundPacket::Floats& albedo, GroundPacket::Floats& out);

}  // namespace hilcam
