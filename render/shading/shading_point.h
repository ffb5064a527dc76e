#pragma once
// A shading point: where a ray has met an object, and how light scatters there.

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

// A shading point that many samples of a pixel see may be a crumpled thing: a normal cluster is a part of it that leans
// otherwise.
struct NormalCluster {
    Vec3f geometric_normal, normal;         // the two normals of a shading point
    Vec3f start_m;                          // where rays that leave it begin, ray space
    float samples = 0;                      // samples of sixteen a pixel that see it
    SampleMask seen_by = 0;                 // those of the visibility buffer; 0: it is not of that
    const LodNormals* flattened = nullptr;  // the normals of the mesh for which it stands; null: itself
    bool goes_on = false;  // the next one is the same triangle there, and leans otherwise as its normals turn
    const NormalCluster* next = nullptr;
};

// Where a ray has met an object, and how the surface lies there.
struct ShadingGeometry {
    Vec3f point_m;           // ray space
    float offset_m;          // distance above the surface at which a ray must start
    Vec3f geometric_normal;  // towards the viewer's side, unit
    Vec3f normal;            // shading, same side
    Vec3f view_dir;          // back along the path, unit
    float footprint_m;       // width of the ray when it came
    std::uint32_t object, triangle;
    std::uint16_t surface_number;  // surface of the object's mesh
    bool back;                     // the side that its triangle's own normal points away from

    // Returns where a ray begins that leaves to this side: above the surface, or below it through glass.
    Vec3f start(bool above = true) const {
        return point_m + (above ? offset_m : -offset_m) * geometric_normal;
    }
};

// The way in which light scatters there.
struct ShadingSurface {
    Bsdf surface;
    SunVisibility
        sun_visibility;   // the mesh's own knowledge of the Sun there, where nothing else stands in the scene
    float sunlit;         // share of it that what lies on it leaves in the Sun (coverage_map.h)
    float cluster_alpha;  // alpha of the lobes of its clusters
    const NormalCluster* clusters;  // the shading point's own among them; null: it is one
};

// The share of the light that it sends which reaches its pixel, or the lobe whose rays have met it.
struct PathThroughput {
    Spectrum throughput;
    float weight_samples;   // samples of sixteen a pixel that see it, where it is not one ray's
    std::uint16_t depth;    // 1: seen by the camera
    LightPart ray_part;     // where a ray has met it: the part of its light
    GlossyRay* glossy_ray;  // the ray along a lobe whose path has met it; null: its light is its pixel's

    // Returns the figure that thresholds are held against: the largest throughput of one of the samples for which
    // a ray stands.
    float importance(const Spectrum& of) const { return max_component(of) / weight_samples; }
};

// Where in the picture it is seen, or the first shading point of its path.
struct PixelCoverage {
    std::uint32_t pixel;      // in the tile
    std::uint16_t sample;     // in the pixel
    SampleMask samples;       // those of the pixel that see its plane; 0: one of a ray
    Vec2f place_px;           // where in the pixel it is seen, where samples see it
    float lift_m;             // where samples see it, rays start further above: planes differ
    SubpixelMoments moments;  // where in the pixel they are
};

// A stage of its light that finds something for a later one returns it as a value: it is no member here.
struct ShadingPoint : ShadingGeometry, ShadingSurface, PathThroughput, PixelCoverage {};

// The orientation of the surface where a ray meets it.
struct SurfaceFrame {
    Vec3f geometric_normal, normal, view_dir;  // those of a shading point
    bool back;
};
// Finds it for a lane that met an object. False where there is nothing to see: a triangle without an area.
// Loop, any thread.
bool find_surface_frame(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f dir,
                        SurfaceFrame& surface_frame);

// Returns how far above a surface a ray must start that was met at a point by a ray from another. The point's rounding grows with
// the coordinates it was made of: 16 half-ulps of the greatest (Waechter & Binder, Ray Tracing Gems, 2019, ch. 6, use a like bound).
float rounding_m(Vec3f point_m, Vec3f origin_m);

// Point, normals and material of a lane that met an object; pixel, sample, depth and throughput are the caller's.
// The facet lobe is at least `alpha_least` wide. False where there is nothing to see. Loop, any thread.
// footprint_m: width of the ray where it began, spread_rad: by how much it widens.
struct RayWidth {
    float footprint_m = 0;
    float spread_rad = 0;
};
bool make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f origin_m, Vec3f dir,
                        float alpha_least, RayWidth width, ShadingPoint& point);
// The same where it is known how the surface lies, but for textures (texture_at()).
void make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                        const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, float alpha_least,
                        RayWidth width, ShadingPoint& point);
// The same but for the surface, for set_surface().
void place_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                         const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, RayWidth width,
                         ShadingPoint& point);
// Gives a shading point one of its object's surfaces, without colours or textures of its own.
void set_surface(const FrameContext& frame, std::uint16_t surface_number, ShadingPoint& point);
// Returns the colours that a texture has about a place of a shading point's triangle, as a factor on those of its material. Loop,
// any thread. share: how much of the shading point's width is looked at, 0..1.
Spectrum texture_at(const FrameContext& frame, const ShadingPoint& point, std::uint32_t triangle, Vec2f uv,
                    float share);
inline bool is_textured(const ShadingPoint& point) { return point.surface.material->texture >= 0; }
// Gives a shading point such colours.
void paint(const Spectrum& colors, ShadingPoint& point);
// Asks for the memory that make_shading_point() reads, of all lanes that met an object.
void prefetch_shading_points(const FrameContext& frame, const HitPacket& hits, int count);

}  // namespace hilcam
