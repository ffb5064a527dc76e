#pragma once
// A shading point: where a ray has met an object, and how light is scattered there.

#include <cstddef>
#include <cstdint>

#include "render/scene/brdf.h"
#include "render/scene/embree_scene.h"
#include "render/shading/frame_context.h"
#include "render/vocabulary/light_part.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/subpixel_light.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct GlossyRay;

// A part of a shading point with its own normal. A point that many samples see may be crumpled or curved, and
// then has several clusters.
struct NormalCluster {
    Vec3f geometric_normal, normal;  // those of a shading point
    Vec3f start_m;                   // where rays from it start, ray space
    float samples = 0;               // samples that see it (16 per pixel)
    SampleMask seen_by = 0;          // samples of the visibility buffer that see it; 0: not from that buffer
    const LodNormals* flattened = nullptr;  // its LOD normals; null: none were flattened
    bool goes_on = false;  // the next cluster is the same triangle with another of its normals
    const NormalCluster* next = nullptr;
};

// Where a ray has met an object, and the orientation of the surface there.
struct ShadingGeometry {
    Vec3f point_m;           // ray space
    float offset_m;          // distance above the surface at which rays must start
    Vec3f geometric_normal;  // on the viewer's side, unit
    Vec3f normal;            // shading normal, same side
    Vec3f view_dir;          // back along the path, unit
    float footprint_m;       // width of the ray when it arrived
    std::uint32_t object, triangle;
    std::uint16_t surface_number;  // number of the surface in the object's mesh
    bool back;                     // seen on the side that its triangle's own normal points away from

    // Returns where a ray to this side starts: above the surface, or below it through glass.
    Vec3f start(bool above = true) const {
        return point_m + (above ? offset_m : -offset_m) * geometric_normal;
    }
};

// The surface's scattering of light there.
struct ShadingSurface {
    Bsdf surface;
    SunVisibility sun_visibility;   // known for the mesh alone; counts if nothing else is in the scene
    float sunlit;                   // share of it that things on top of it leave in sunlight (coverage_map.h)
    float cluster_alpha;            // alpha of its clusters' lobes
    const NormalCluster* clusters;  // all clusters, including its own; null: there is only one
};

// The way in which the light that it sends reaches its pixel, or the lobe whose ray has met it.
struct PathThroughput {
    Spectrum throughput;
    float weight_samples;   // samples (16 per pixel) that see it; 1 for a single ray
    std::uint16_t depth;    // 1: seen by the camera
    LightPart ray_part;     // part of the light, for a point that a ray has met
    GlossyRay* glossy_ray;  // the lobe's ray whose path has met it; null: its light goes to its pixel

    // Returns the value to compare with thresholds: the largest throughput per sample that the ray
    // represents.
    float importance(const Spectrum& of) const { return max_component(of) / weight_samples; }
};

// Where in the picture it, or the first shading point of its path, is seen.
struct PixelCoverage {
    std::uint32_t pixel;   // in the tile
    std::uint16_t sample;  // in the pixel
    SampleMask samples;    // samples of the pixel that see its plane; 0: it belongs to a ray
    Vec2f place_px;        // where in the pixel samples see it
    float lift_m;          // additional height of ray starts when samples see it in slightly different planes
    SubpixelMoments moments;  // where in the pixel its samples are
};

// Stages of shading pass results to later stages as return values; they do not become members here.
struct ShadingPoint : ShadingGeometry, ShadingSurface, PathThroughput, PixelCoverage {};

// The orientation of the surface where a ray meets it.
struct SurfaceFrame {
    Vec3f geometric_normal, normal, view_dir;  // those of a shading point
    bool back;
};
// Finds it for a lane that met an object. Returns false if nothing is seen: the triangle has no area. Loop,
// any thread.
bool find_surface_frame(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f dir,
                        SurfaceFrame& surface_frame);

// Returns how far above a surface a ray must start that was met at a point by a ray from `origin_m`. The
// point's rounding error grows with its coordinates: 16 half-ulps of the largest (Waechter & Binder, Ray
// Tracing Gems, 2019, ch. 6, use a similar bound).
float rounding_m(Vec3f point_m, Vec3f origin_m);

// Finds point, normals and material of a lane that met an object; the caller sets pixel, sample, depth and
// throughput. The facet lobe is at least `alpha_least` wide. Returns false if nothing is seen. Loop, any
// thread. footprint_m: width of the ray at its start; spread_rad: how fast it widens.
struct RayWidth {
    float footprint_m = 0;
    float spread_rad = 0;
};
bool make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f origin_m, Vec3f dir,
                        float alpha_least, RayWidth width, ShadingPoint& point);
// The same with a known surface frame, without textures (texture_at()).
void make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                        const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, float alpha_least,
                        RayWidth width, ShadingPoint& point);
// The same without the surface, which set_surface() sets.
void place_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                         const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, RayWidth width,
                         ShadingPoint& point);
// Sets one of the object's surfaces as the shading point's, without vertex colours or textures.
void set_surface(const FrameContext& frame, std::uint16_t surface_number, ShadingPoint& point);
// Returns a texture's colours around a place of the shading point's triangle, as a factor on the material's.
// share: part of the shading point's width that is averaged, 0..1. Loop, any thread.
Spectrum texture_at(const FrameContext& frame, const ShadingPoint& point, std::uint32_t triangle, Vec2f uv,
                    float share);
inline bool is_textured(const ShadingPoint& point) { return point.surface.material->texture >= 0; }
// Multiplies the shading point's spectra by such colours.
void paint(const Spectrum& colors, ShadingPoint& point);
// Prefetches the memory that make_shading_point() reads, for all lanes that met an object.
void prefetch_shading_points(const FrameContext& frame, const HitPacket& hits, int count);

}  // namespace hilcam
