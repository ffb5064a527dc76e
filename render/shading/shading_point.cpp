#include "render/shading/shading_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hilcam {

void prefetch_shading_points(const FrameContext& frame, const HitPacket& hits, int count) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        if (hits.object[k] == HitPacket::kMiss) continue;
        const ObjectSurfaces& object = *(*frame.objects)[hits.object[k]];
        __builtin_prefetch(&object.triangles[hits.triangle[k]]);
        if (object.corner_uvs.empty()) continue;
        __builtin_prefetch(&object.corner_uvs[hits.triangle[k]]);
        __builtin_prefetch(&object.uv_per_m[hits.triangle[k]]);
    }
}

namespace {

// Member by member: a Bsdf that is made first and then copied waits for its own stores.
void set_material(const Material& material, float alpha_least, ShadingPoint& point) {
    const float alpha = material.has_facets() ? std::max(material.ggx_alpha, alpha_least) : 0.0f;
    point.surface.material = &material;
    point.surface.alpha = alpha;
    point.surface.base = material.base;
    point.surface.highlight = material.highlight;
    point.surface.hapke.reset();
    point.cluster_alpha = alpha;
}

}  // namespace

void set_surface(const FrameContext& frame, std::uint16_t surface_number, ShadingPoint& point) {
    point.surface_number = surface_number;
    set_material((*frame.objects)[point.object]->materials[surface_number], 0, point);
}

bool find_surface_frame(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f dir,
                        SurfaceFrame& surface_frame) {
    const auto k = static_cast<std::size_t>(lane);
    const ObjectSurfaces& object = *(*frame.objects)[hits.object[k]];
    const Mat3f& world_from_body = frame.world_from_body[hits.object[k]];
    const PackedTriangle& triangle = object.triangles[hits.triangle[k]];

    Vec3f geometric_raw{hits.normal_x[k], hits.normal_y[k], hits.normal_z[k]};
    float squared = dot(geometric_raw, geometric_raw);
    // Twice the area, squared. For edges below 1e-8 m or above 1e7 m it leaves the range of single precision.
    if (!(squared > 1e-30f && squared < 1e30f)) {
        const float greatest =
            std::max({std::abs(geometric_raw.x), std::abs(geometric_raw.y), std::abs(geometric_raw.z)});
        if (!(greatest > 0 && std::isfinite(greatest))) return false;  // without an area: nothing to see
        geometric_raw = geometric_raw / greatest;
        squared = dot(geometric_raw, geometric_raw);
    }
    const Vec3f geometric_body = geometric_raw / std::sqrt(squared);

    surface_frame.view_dir = -normalized(dir);
    Vec3f geometric = world_from_body * geometric_body;
    Vec3f normal_body;
    if (!object.ground_normals ||
        !object.ground_normals->find(hits.triangle[k], hits.u[k], hits.v[k], normal_body))
        normal_body = ObjectSurfaces::normal_at(triangle, hits.u[k], hits.v[k], geometric_body);
    Vec3f normal = world_from_body * normal_body;
    surface_frame.back = dot(geometric, surface_frame.view_dir) < 0;
    if (surface_frame.back) geometric = -geometric;
    if (dot(normal, geometric) < 0) normal = -normal;
    // A smoothed normal that faces away from the viewer would make the surface vanish.
    if (dot(normal, surface_frame.view_dir) <= 1e-4f) normal = geometric;
    surface_frame.geometric_normal = geometric;
    surface_frame.normal = normal;
    return true;
}

float rounding_m(Vec3f p, Vec3f o) {
    const float greatest =
        std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), std::abs(o.x), std::abs(o.y), std::abs(o.z)});
    return 16 * std::numeric_limits<float>::epsilon() * greatest;
}

bool make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane, Vec3f origin_m, Vec3f dir,
                        float alpha_least, RayWidth width, ShadingPoint& point) {
    SurfaceFrame surface_frame;
    if (!find_surface_frame(frame, hits, lane, dir, surface_frame)) return false;
    make_shading_point(frame, hits, lane, surface_frame, origin_m, dir, alpha_least, width, point);
    const auto k = static_cast<std::size_t>(lane);
    if (is_textured(point))
        paint(texture_at(frame, point, hits.triangle[k], {hits.u[k], hits.v[k]}, 1), point);
    return true;
}

void place_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                         const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, RayWidth width,
                         ShadingPoint& point) {
    const auto k = static_cast<std::size_t>(lane);
    const ObjectSurfaces& object = *(*frame.objects)[hits.object[k]];
    point.view_dir = surface_frame.view_dir;
    point.geometric_normal = surface_frame.geometric_normal;
    point.normal = surface_frame.normal;
    point.back = surface_frame.back;
    point.sunlit = 1;
    point.weight_samples = 1;
    point.samples = 0;
    point.clusters = nullptr;

    point.footprint_m = width.footprint_m + width.spread_rad * hits.distance[k] * length(dir);
    point.point_m = origin_m + hits.distance[k] * dir;
    point.offset_m = rounding_m(point.point_m, origin_m);

    point.object = hits.object[k], point.triangle = hits.triangle[k];
    point.glossy_ray = nullptr;
    point.sun_visibility = object.sun_visibility.empty() || frame.objects->size() > 1
                               ? SunVisibility::kAsk
                               : object.sun_visibility[hits.triangle[k]];
}

void make_shading_point(const FrameContext& frame, const HitPacket& hits, int lane,
                        const SurfaceFrame& surface_frame, Vec3f origin_m, Vec3f dir, float alpha_least,
                        RayWidth width, ShadingPoint& point) {
    const auto k = static_cast<std::size_t>(lane);
    const ObjectSurfaces& object = *(*frame.objects)[hits.object[k]];
    const PackedTriangle& triangle = object.triangles[hits.triangle[k]];
    const Material& material = object.materials[triangle.surface];
    const float u = hits.u[k];
    const float v = hits.v[k];
    place_shading_point(frame, hits, lane, surface_frame, origin_m, dir, width, point);
    point.surface_number = triangle.surface;
    set_material(material, alpha_least, point);
    if (!object.corner_colors.empty())
        paint(frame.bands->spectrum(object.color_at(hits.triangle[k], u, v)), point);
    if (!object.corner_hapke.empty()) point.surface.hapke = object.hapke_at(hits.triangle[k], u, v);
}

Spectrum texture_at(const FrameContext& frame, const ShadingPoint& point, std::uint32_t triangle, Vec2f at,
                    float share) {
    const ObjectSurfaces& object = *(*frame.objects)[point.object];
    const auto& corner = object.corner_uvs[triangle];
    const MipTexture& texture = (*object.textures)[static_cast<std::size_t>(point.surface.material->texture)];
    // The footprint is longer on an oblique surface; its shorter side counts, up to a factor of four.
    const float slant = 1 / std::max(0.25f, dot(point.geometric_normal, point.view_dir));
    const float footprint = share * point.footprint_m * std::sqrt(slant) * object.uv_per_m[triangle];
    const float first = 1 - at.x - at.y;
    return frame.bands->spectrum(texture.sample(first * corner[0].x + at.x * corner[1].x + at.y * corner[2].x,
                                                first * corner[0].y + at.x * corner[1].y + at.y * corner[2].y,
                                                footprint));
}

// A file's only colour scales the larger part of the material.
void paint(const Spectrum& colors, ShadingPoint& point) {
    point.surface.base = point.surface.base * colors;
    if (point.surface.material->is_bare()) point.surface.highlight = point.surface.highlight * colors;
}

}  // namespace hilcam
