#include "render/paths/glossy_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "render/brdf/microfacet.h"
#include "render/glossy/glossy_reuse.h"

namespace hilcam {
namespace {

constexpr int kLobeRays = 4;  // rays of a narrow lobe at the first surface, when neighbours do not share them

void add(const Tile& tile, const NextRay& ray, NextRays& rays) {
    if (!(ray.from->importance(ray.throughput) >= tile.frame.contribution_threshold)) return;
    const bool leaves = dot(ray.from->geometric_normal, ray.dir) > 0;
    const bool through = ray.from->surface.is_glass();
    if (leaves || through) rays.add(ray);
}

void add_through_glass(const Tile& tile, const ShadingPoint& at, NextRays& rays) {
    for (const int part : {0, 1}) {
        const BrdfSample exact = brdf_exact(at.surface, at.normal, at.view_dir, part);
        if (!exact.valid) continue;
        NextRay ray{&at, at.start(part == 0), exact.dir, 0, 0, true, at.throughput * exact.weight};
        ray.part = part == 0 ? LightPart::kMirrorRays : LightPart::kTransmission;
        add(tile, ray, rays);
    }
}

// Adds the rays of a lobe that is too narrow to be cached, without its tails. mirror: the lobe's middle.
void add_in_narrow_lobe(const Tile& tile, const ShadingPoint& at, Vec3f mirror, const Spectrum& weight,
                        NextRays& rays) {
    const float alpha = at.surface.alpha;
    const float core = 1 - tail_share(alpha);
    // Behind the first surface one ray along the lobe's middle represents it, so that rays do not multiply.
    const int count = at.depth == 1 ? kLobeRays : 1;
    const Frame local(at.normal);
    for (int i = 0; i < count; ++i) {
        NextRay ray{&at, at.start(), mirror, 0, alpha, false, (core / static_cast<float>(count)) * weight};
        ray.part = LightPart::kGlossyRays;
        if (count > 1) {
            const float u1 = core * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
            const float u2 = std::fmod(0.25f * static_cast<float>(i) + 0.125f, 1.0f);
            ray.dir = normalized(reflect(at.view_dir, local.to_world(sample_visible_normal(
                                                          alpha, local.to_local(at.view_dir), u1, u2))));
        }
        add(tile, ray, rays);
    }
}

// Returns the distance within which the rays of pixels serve a lobe. Where normals differ or lobes are narrow,
// farther rays are worth less: with the whole pattern everywhere, a quarter more of geo_inspection's blocks
// are off by a tenth.
int reach_px(const ShadingPoint& at) {
    return at.clusters || at.surface.alpha < kMinCachedAlpha ? kGlossyPattern_px / 2 : kGlossyPattern_px;
}

// Returns the smallest alpha of facet lobes that a ray of this density meets. The ray represents a cone of
// directions, and a facet that leans by half of the cone's half angle mirrors its rim (path space
// regularization: Kaplanyan & Dachsbacher, CGF 32(2), 2013). So a highlight that one ray of a lobe's tail
// finds does not count for the whole tail.
float cone_alpha(float per_density_sr) {
    constexpr float kShared =
        32;  // rays that share a lobe; from 16 to 64 errors of the zoo differ by less than 5 %
    return 0.5f * std::sqrt(per_density_sr / (kPiF * kShared));
}

// Some meshes have faces twice, or faces that cross within a pixel. Rays start above both, at this share of
// the pixel's width. Without it Hubble's rods are black in the light of the Earth (p99 25 instead of 21 sensor
// noises); 0.05 leaks light into crevices.
constexpr float kClearOfDoubles = 0.02f;

// Starts a lobe that the camera sees: one ray, or two where fewer pixels share them. add_further_rays() adds
// more where they are needed.
void begin_lobe(Tile& tile, const ShadingPoint& at, GlossyPoint& lobe, NextRays& rays) {
    lobe.reach_px = reach_px(at);
    const int count = kGlossyPattern_px / lobe.reach_px;
    // Thresholds apply to what the ray finds times the lobe's share.
    const float scale = max_component(lobe.weight) / static_cast<float>(count);
    if (!(scale > 0)) return;
    lobe.per_light = 1 / scale;
    lobe.start_m = at.start() + kClearOfDoubles * at.footprint_m * at.geometric_normal;
    add_along_lobe(tile, at, lobe, count, rays);
}

}  // namespace

void add_along_lobe(Tile& tile, const ShadingPoint& at, GlossyPoint& lobe, int count, NextRays& rays) {
    const int width = tile.box.x1 - tile.box.x0;
    const int x = tile.box.x0 + static_cast<int>(at.pixel) % width,
              y = tile.box.y0 + static_cast<int>(at.pixel) / width;
    const Frame local(at.normal);
    const float no = std::max(dot(at.normal, at.view_dir), 1e-2f);
    const Planetshine& planetshine = tile.frame.indirect->planetshine();
    for (; count > 0 && !rays.full(); --count) {
        const GlossyPlace place = glossy_place(x, y, lobe.sent++, lobe.reach_px);
        const Vec3f facet = local.to_world(
            sample_visible_normal(lobe.alpha, local.to_local(at.view_dir), place.u1, place.u2));
        const Vec3f dir = normalized(reflect(at.view_dir, facet));
        if (!(dot(at.geometric_normal, dir) > 0 && dot(at.normal, dir) > 0)) continue;
        GlossyRay* const own = tile.glossy->add_ray(lobe);
        if (!own) return;
        own->met_m = dir;
        for (std::size_t b = 0; b < planetshine.bodies().size(); ++b)
            own->towards[b] = planetshine.brightness(b, dir);
        own->per_density_sr = 1 / ggx_density(lobe.alpha, no, std::min(dot(at.normal, facet), 1.0f));
        const float alpha = std::min(std::hypot(lobe.alpha, cone_alpha(own->per_density_sr)), 1.0f);
        NextRay ray{&at, lobe.start_m, dir, 0, alpha, false, {}};
        ray.throughput.bin.fill(1 / lobe.per_light);
        ray.sees_bodies = false, ray.part = LightPart::kGlossyRays, ray.glossy = own;
        rays.add(ray);
    }
}

void add_glossy_rays(Tile& tile, const ShadingPoint& at, const GlossyRequest& request, NextRays& rays) {
    const Bsdf& surface = at.surface;
    if (surface.is_glass()) return add_through_glass(tile, at, rays);
    if (request.point) return begin_lobe(tile, at, *request.point, rays);
    if (!surface.material->has_facets() || surface.alpha >= kMinCachedAlpha) return;
    const Spectrum weight = at.throughput * tile.frame.indirect->lobe_albedo(at);
    // A table's directions may miss a mast, so a good mirror always gets a ray.
    const bool is_bright = surface.alpha < kNarrowestLobe && at.importance(weight) >= kBrightLobe;
    if (request.has_bodies && surface.alpha > 0 && !is_bright) return;
    const Vec3f mirror = normalized(reflect(at.view_dir, at.normal));
    if (surface.alpha < kNarrowestLobe) {
        const bool meets_sun = surface.alpha == 0;
        NextRay ray{&at, at.start(), mirror, 0, surface.alpha, meets_sun, weight, true, !request.has_bodies};
        ray.part = LightPart::kMirrorRays;
        ray.may_be_many = is_bright && at.depth == 1 && at.samples != 0 && !at.clusters;
        // A poor mirror gets no ray if nothing is near.
        if (request.mirrors_near || is_bright)
            add(tile, ray, rays);
        else if (dot(at.geometric_normal, mirror) > 0)
            add_background(tile, ray);
        return;
    }
    // If nothing is near, the lobe contains only bodies, which indirect_cache.h adds.
    if (request.mirrors_near) add_in_narrow_lobe(tile, at, mirror, weight, rays);
}

ShadingPoint shading_point_of(const GlossyPoint& lobe) {
    ShadingPoint at{};
    at.point_m = lobe.point_m, at.geometric_normal = lobe.geometric_normal, at.normal = lobe.normal;
    at.view_dir = lobe.view_dir, at.footprint_m = lobe.footprint_m;
    at.object = lobe.object, at.triangle = lobe.triangle;
    at.surface_number = lobe.surface, at.back = lobe.back, at.surface.alpha = lobe.alpha;
    at.depth = 1, at.weight_samples = lobe.weight_samples;
    at.pixel = lobe.pixel, at.samples = lobe.samples, at.moments = lobe.moments;
    return at;
}

}  // namespace hilcam
