#include "render/paths/glossy_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "render/brdf/microfacet.h"
#include "render/visibility/place_sequence.h"

namespace hilcam {
namespace {

constexpr int kLobeRays = 4;  // rays that follow a narrow lobe at the first surface
// A mirror of this reflectance is looked into in any case: a glint in it is as bright as paint.
constexpr float kBright = 0.1f;

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

// Adds the rays of a lobe that is too narrow to be cached, and none's tails; mirror: its middle.
void add_in_narrow_lobe(const Tile& tile, const ShadingPoint& at, Vec3f mirror, const Spectrum& weight,
                        NextRays& rays) {
    const float alpha = at.surface.alpha;
    const float core = 1 - tail_share(alpha);
    // Behind the first surface the lobe's middle stands for all of it: rays do not multiply.
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

// One for two of a pixel's samples, and for four of those beyond: of a square of four pixels, 20 rays instead of 32.
float rays_for(float samples) {
    constexpr float kOfPixel = 0.5f, kBeyond = 0.25f, kPixel = kVisibilitySamples;
    return std::max(1.0f, kOfPixel * std::min(samples, kPixel) + kBeyond * std::max(samples - kPixel, 0.0f));
}

}  // namespace

void GlossyRays::add_of(Tile& tile, const Asking& asking, std::size_t number, NextRays& rays) {
    const ShadingPoint& at = asking.points[number];
    const GlossyRequest& request = asking.requests[number];
    const Bsdf& surface = at.surface;
    if (surface.is_glass()) return add_through_glass(tile, at, rays);
    if (request.wants_glossy_rays) send_glossy_rays(tile, asking, number, rays);
    if (!surface.material->has_facets() || surface.alpha >= kMinCachedAlpha) return;
    const Spectrum weight = at.throughput * tile.frame.indirect->lobe_albedo(at);
    // The directions of a table pass a mast by: what a good mirror shows is looked for anyway.
    const bool is_bright = surface.alpha < kNarrowestLobe && at.importance(weight) >= kBright;
    if (request.has_bodies && surface.alpha > 0 && !is_bright) return;
    const Vec3f mirror = normalized(reflect(at.view_dir, at.normal));
    if (surface.alpha < kNarrowestLobe) {
        const bool meets_sun = surface.alpha == 0;
        NextRay ray{&at, at.start(), mirror, 0, surface.alpha, meets_sun, weight, true, !request.has_bodies};
        ray.part = LightPart::kMirrorRays;
        ray.may_be_many = is_bright && at.depth == 1 && at.samples != 0 && !at.clusters;
        // What bad mirrors show is not looked for where nothing stands near.
        if (request.mirrors_near || is_bright)
            add(tile, ray, rays);
        else if (dot(at.geometric_normal, mirror) > 0)
            add_background(tile, ray);
        return;
    }
    // Where nothing stands near, the bodies in a lobe are all there is, and indirect_cache.h has them.
    if (request.mirrors_near) add_in_narrow_lobe(tile, at, mirror, weight, rays);
}

// Gives the pixels of shading points that the same rays serve, from the first on, their shares of what these find.
GlossyRays::Followers GlossyRays::share_rays(const Tile& tile, const Asking& asking, std::size_t number) {
    const ShadingPoint& first = asking.points[number];
    const GlossyRequest& request = asking.requests[number];
    Followers out;
    const std::size_t begin = share_count_;
    for (std::size_t i = number; i != GlossyRequest::kNobody; i = asking.requests[i].next) {
        const ShadingPoint& at = asking.points[i];
        out.point[out.count++] = &at;
        out.samples += at.weight_samples;
        const float samples = at.weight_samples / first.weight_samples;
        shares_[share_count_++] = {at.pixel, at.moments, samples * tile.frame.indirect->lobe_tint(at)};
    }
    out.lobe = &lobes_[lobe_count_++];
    *out.lobe = {
        {shares_.data() + begin, out.count}, request.cached_lobe, request.cached_lobe_directions, {}, {}, {}};
    return out;
}

// Rays drawn as the lobe sends; each that leaves has an equal share of what that sends in all.
void GlossyRays::send_glossy_rays(Tile& tile, const Asking& asking, std::size_t number, NextRays& rays) {
    const ShadingPoint& at = asking.points[number];
    const auto width = static_cast<std::uint32_t>(tile.box.x1 - tile.box.x0);
    const auto quarter = static_cast<float>(at.pixel % width % 2 + 2 * (at.pixel / width % 2));
    const Followers followers = share_rays(tile, asking, number);
    const std::size_t count =
        std::min(static_cast<std::size_t>(std::lround(rays_for(followers.samples))), GlossyLobe::kMaxRays);
    const Frame local(at.normal);
    const std::size_t first = rays.count;
    for (std::size_t i = 0; i < count && !rays.full(); ++i) {
        const ShadingPoint& from = *followers.point[i % followers.count];
        const auto sample = static_cast<float>(at.sample + i);
        const Vec3f facet = local.to_world(sample_visible_normal(
            at.surface.alpha, local.to_local(at.view_dir), std::fmod(0.5f + kPlasticAlong * sample, 1.0f),
            std::fmod(0.25f * quarter + kPlasticAbout * sample, 1.0f)));
        const Vec3f dir = normalized(reflect(at.view_dir, facet));
        if (dot(from.geometric_normal, dir) > 0 && dot(at.normal, dir) > 0)
            rays.add({&at,
                      from.start(),
                      dir,
                      0,
                      at.surface.alpha,
                      false,
                      {},
                      false,
                      false,
                      {},
                      LightPart::kGlossyRays});
    }
    const std::span<NextRay> own = rays.room.subspan(first, rays.count - first);
    const Spectrum weight = (1 / static_cast<float>(std::max<std::size_t>(own.size(), 1))) *
                            (at.throughput * tile.frame.indirect->plain_lobe_albedo(at));
    IndirectCache::LobeRays bodies(*tile.frame.indirect, at);
    for (const NextRay& ray : own) bodies.count(ray.dir);
    std::uint8_t of_lobe = 0;
    for (NextRay& ray : own) {
        ray.throughput = weight, ray.if_free = at.throughput * bodies.share(ray.dir);
        ray.lobe = followers.lobe, ray.lobe_ray = of_lobe++;
    }
}

void GlossyRays::add_found(Tile& tile) const {
    const std::span<const GlossyLobe> lobes = std::span(lobes_).first(lobe_count_);
    const float share = found_over_believed(lobes);
    for (const GlossyLobe& lobe : lobes) tile.add(lobe, share * lobe.believed());
}

}  // namespace hilcam
