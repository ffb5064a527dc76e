#pragma once
// A path at one of its vertices: where a ray has met an object, and how light scatters there.

#include "render/embree_scene.h"
#include "render/frame_view.h"
#include "render/spectrum.h"
#include "render/vec.h"

namespace hilcam {

struct Vertex {
    std::uint32_t pixel;     // in the tile
    std::uint32_t sample;    // in the pixel
    Vec3f point_m;           // ray space
    float offset_m;          // how far a ray must start above the surface
    Vec3f geometric_normal;  // towards the viewer's side, unit
    Vec3f normal;            // shading, same side
    Vec3f view_dir;          // back along the path, unit
    float alpha;             // GGX, as used at this vertex
    bool specular;
    bool mirror;
    Spectrum weight;
    Spectrum diffuse_albedo;
    Spectrum normal_reflectance;
};

// Whether a lane of the packet met an object, and not the Earth before it. Origin and direction are the
// ray's, in ray space. Loop, any thread.
bool meets_object(const FrameView& frame, const HitPacket& hits, int lane, Vec3f origin_m, Vec3f dir);

// Point, normals and material of a lane that met an object; pixel, sample and weight are the caller's. The
// lobe is at least `alpha_least` wide. False where there is nothing to see: a triangle without an area. Loop,
// any thread.
bool make_vertex(const FrameView& frame, const HitPacket& hits, int lane, Vec3f origin_m, Vec3f dir,
                 float alpha_least, Vertex& vertex);

// Over the bins of the grid.
inline float mean(const Spectrum& s, int bins) {
    float sum = 0;
    for (int b = 0; b < kMaxBins; ++b) sum += s[b];
    return sum / static_cast<float>(bins);
}

}  // namespace hilcam
