// One random path per sample, in waves of packets: each shading point sends rays to the lights (next-event
// estimation) and one ray in a direction drawn from its own BRDF. Where both can find the same light, they
// are weighted by the balance heuristic (Veach & Guibas, SIGGRAPH 95). A path that can add less than
// contribution_threshold continues by chance, with a correspondingly larger weight (Russian roulette; Arvo &
// Kirk, SIGGRAPH 90).
//
// On surfaces with cached light (indirect_cache.h) nothing is random: the path ends there, except for rays in
// fixed directions (glossy_rays.h).

#include "render/paths/path_models.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "render/indirect/indirect_cache.h"
#include "render/paths/glossy_adaptive.h"
#include "render/paths/glossy_rays.h"
#include "render/paths/mirror_rays.h"
#include "render/paths/next_ray.h"
#include "render/primary/primary_hits.h"
#include "render/shading/radiance_model.h"

namespace hilcam {
namespace {

class TracedPaths final : public PathModel {
  public:
    explicit TracedPaths(bool cached) : cached_(cached) {}

    void trace(Tile& tile) override {
        PrimaryHits seen(tile);
        while (const std::size_t count = seen.next({current_, kMax})) trace_on(tile, count, 1);
        if (tile.glossy) add_further_rays(tile);
    }

    bool samples_lobes() const override { return true; }
    bool uses_indirect_cache() const override { return cached_; }

  private:
    bool cached_;
    static constexpr auto kMax = static_cast<std::size_t>(kMaxShadingPoints);
    // Room for at least this many rays for each mirror whose single ray would meet only a part of what it
    // shows, and for more if others need fewer.
    static constexpr std::size_t kMinOfMirror = 8;
    static constexpr std::size_t kMaxRays = (kMinOfMirror + 5) * kMax;
    std::array<ShadingPoint, kMaxRays> a_, b_;
    std::array<NextRay, kMaxRays> next_;
    std::array<GlossyRequest, kMaxRays> requests_;  // one for each shading point in work with cached light
    ShadingPoint* current_ = a_.data();
    ShadingPoint* following_ = b_.data();
    // Hits of the first rays of mirrors that may become many; and by pixel of the tile, whether these hit a
    // small part nearby.
    std::array<HitPacket, (kMax + kPacketSize - 1) / kPacketSize> mirror_hits_;
    std::array<bool, kMaxSamples> near_part_;
    MirrorRays many_;

    // Adds rays to the tile's lobes that need them, some lobes at a time: later ones share them.
    void add_further_rays(Tile& tile) {
        constexpr std::size_t kTogether = 64;
        const std::span<GlossyPoint> lobes = tile.glossy->points();
        for (std::size_t next = 0; next < lobes.size();) {
            tile.glossy_frame->link(*tile.glossy);
            NextRays rays{next_};
            for (std::size_t count = 0; next < lobes.size() && count < kTogether; ++next) {
                const int further = further_rays(tile, lobes[next]);
                if (further == 0) continue;
                current_[count] = shading_point_of(lobes[next]);
                add_along_lobe(tile, current_[count++], lobes[next], further, rays);
            }
            trace_on(tile, follow(tile, rays.count, tile.frame.max_depth == 1), 2);
        }
    }

    // Follows paths from shading points of this depth.
    void trace_on(Tile& tile, std::size_t count, int depth) {
        const FrameContext& frame = tile.frame;
        for (; count > 0; ++depth) {
            std::size_t keep = 0;
            if (frame.indirect) {
                ShadingPoint* const others =
                    std::partition(current_, current_ + count,
                                   [&](const ShadingPoint& v) { return frame.is_cached[v.object] != 0; });
                keep = static_cast<std::size_t>(others - current_);
                frame.radiance->add_light(tile, {current_, keep}, BodySampling::kNone);
                frame.indirect->add_reflected(tile, {current_, keep}, requests_);
                frame.indirect->add_mirror_sunlight(tile, {current_, keep});
            }
            frame.radiance->add_light(tile, {current_ + keep, count - keep}, BodySampling::kSampled);
            const bool last = depth == frame.max_depth;
            NextRays rays{next_};
            for (std::size_t i = 0; i < keep; ++i) add_glossy_rays(tile, current_[i], requests_[i], rays);
            choose(tile, {current_ + keep, count - keep}, last, rays);
            count = follow(tile, rays.count, last);
        }
    }

    // Draws a direction at each shading point. At the last surface only exact ones continue, because they
    // include no light yet.
    static void choose(const Tile& tile, std::span<const ShadingPoint> points, bool last, NextRays& rays) {
        const FrameContext& frame = tile.frame;
        const float least = frame.contribution_threshold;
        for (const ShadingPoint& at : points) {
            if (rays.full()) return;
            if (last && !at.surface.has_exact()) continue;
            const auto random = tile.random_of(at, 0);
            const BrdfSample sample =
                brdf_sample(at.surface, at.normal, at.view_dir,
                            {uniform01(random[0]), uniform01(random[1]), uniform01(random[2])});
            if (!sample.valid || (last && !sample.exact) ||
                (!sample.transmits && dot(at.geometric_normal, sample.dir) <= 0))
                continue;
            Spectrum weight = at.throughput * sample.weight;
            const float most = at.importance(weight);
            if (!(most > 0)) continue;
            if (most < least) {
                const float chance = most / least;
                if (uniform01(random[3]) >= chance) continue;
                weight = (1 / chance) * weight;
            }
            // A facet lobe met through another is at least as wide as that one. Behind a diffuse bounce it is
            // as wide as the quality says, which keeps the mean and removes sparkle (Kaplanyan & Dachsbacher,
            // CGF 32(2), 2013).
            const float alpha_least = frame.alpha_behind_diffuse > 0
                                          ? (sample.diffuse ? frame.alpha_behind_diffuse : at.surface.alpha)
                                          : 0.0f;
            NextRay ray{&at,   at.start(!sample.transmits), sample.dir, sample.density, alpha_least, true,
                        weight};
            if (sample.exact) ray.part = sample.transmits ? LightPart::kTransmission : LightPart::kMirrorRays;
            rays.add(ray);
        }
    }

    // True when a mirror's ray has met only a part of what the mirror shows there: the triangle is small
    // compared with the ray's width, so other triangles, or none, are within it or within a pixel or two. One
    // of them may send a glint, or nothing.
    static bool has_met_a_part(const HitPacket& hits, std::size_t k, const NextRay& ray) {
        constexpr float kSmall = 4;
        const float size_m = std::sqrt(length(Vec3f{hits.normal_x[k], hits.normal_y[k], hits.normal_z[k]}));
        const float width_m = ray.from->footprint_m + 2 * ray.from->surface.alpha * hits.distance[k];
        return size_m < kSmall * width_m;
    }

    // Traces many rays for a mirror's pixel, at most `most`, instead of the one from its middle. Returns
    // their number.
    std::size_t follow_many(Tile& tile, const NextRay& middle, std::size_t most, std::size_t& found) {
        const std::size_t sent = many_.trace(tile, *middle.from, most);
        NextRay ray = middle;
        const float share = 1 / static_cast<float>(sent);
        ray.throughput = share * middle.throughput;
        Spectrum free;
        add_background_seen(tile.frame, middle, free);
        const std::size_t begin = found;
        for (const MirrorRays::Packet& packet : many_.packets()) {
            const int met_nothing = packet.rays.count - std::popcount(packet.met);
            if (met_nothing > 0)
                tile.add(*middle.from, LightPart::kMirrorRays,
                         (share * static_cast<float>(met_nothing)) * free);
            for (std::uint32_t rest = packet.met; rest != 0; rest &= rest - 1) {
                const auto k = static_cast<std::size_t>(std::countr_zero(rest));
                ray.origin_m = packet.rays.origin(k), ray.dir = packet.rays.dir(k);
                if (add_met(tile.frame, packet.hits, k, ray, found) && !join(ray, following_, begin, found))
                    ++found;
            }
        }
        return sent;
    }

    // Traces some of the chosen rays.
    const HitPacket& trace_packet(Tile& tile, std::size_t first, std::size_t count, Coherence coherence,
                                  HitPacket& hits) const {
        RayPacket rays;
        rays.count = static_cast<int>(count);
        for (int i = 0; i < rays.count; ++i) {
            const NextRay& ray = next_[first + static_cast<std::size_t>(i)];
            rays.set(i, ray.origin_m, ray.dir, 0, std::numeric_limits<float>::infinity());
        }
        tile.frame.scene->intersect(rays, coherence, hits);
        prefetch_shading_points(tile.frame, hits, rays.count);
        tile.stats.secondary_rays += count;
        return hits;
    }

    // Appends the hit of a ray as a shading point. Returns false if nothing is seen.
    bool add_met(const FrameContext& frame, const HitPacket& hits, std::size_t k, const NextRay& ray,
                 std::size_t found) {
        ShadingPoint& point = following_[found];
        if (!make_shading_point(frame, hits, static_cast<int>(k), ray.origin_m, ray.dir, ray.alpha_least,
                                ray.width(), point))
            return false;
        point.pixel = ray.from->pixel, point.sample = ray.from->sample;
        point.moments = ray.from->moments;
        point.glossy_ray = ray.from->glossy_ray ? ray.from->glossy_ray : ray.glossy;
        point.depth = static_cast<std::uint16_t>(ray.from->depth + 1);
        point.throughput = ray.throughput;
        point.ray_part = ray.from->depth > 1 ? ray.from->ray_part : ray.part;
        point.weight_samples = ray.from->weight_samples;
        return true;
    }

    // Sorts the rays that may become many to the front and traces them. If one of them meets a small part,
    // the rays of surrounding pixels, whose lobes contain some of it, may have missed it. Returns their
    // number.
    std::size_t trace_mirrors(Tile& tile, std::size_t ray_count) {
        const auto begin = next_.begin();
        const auto mirrors =
            static_cast<std::size_t>(std::partition(begin, begin + static_cast<std::ptrdiff_t>(ray_count),
                                                    [](const NextRay& ray) { return ray.may_be_many; }) -
                                     begin);
        if (mirrors > 0) near_part_.fill(false);
        for (std::size_t first = 0; first < mirrors; first += kPacketSize) {
            const std::size_t count = std::min<std::size_t>(kPacketSize, mirrors - first);
            const HitPacket& hits =
                trace_packet(tile, first, count, Coherence::kCoherent, mirror_hits_[first / kPacketSize]);
            for (std::size_t k = 0; k < count; ++k) {
                const NextRay& ray = next_[first + k];
                if (meets_object(tile.frame, hits, k, ray.origin_m, ray.dir) && has_met_a_part(hits, k, ray))
                    mark_about(tile, *ray.from, hits.distance[k]);
            }
        }
        return mirrors;
    }

    // Marks the pixels whose lobes may contain something that a mirror shows at this distance.
    void mark_about(const Tile& tile, const ShadingPoint& mirror, float distance_m) {
        // Four fifths of a lobe come from facets within twice alpha, which turn rays by twice that angle
        // (Walter et al. 2007, eq. 35).
        constexpr float kLobe = 4;
        constexpr float kMax_px = 4;  // a pixel farther away has little of it, and rays cost time
        const auto focal_px = static_cast<float>(tile.frame.geometry.focal_length_px);
        const float in_all_m = mirror.footprint_m * focal_px + distance_m;
        const float blur_px = kLobe * mirror.surface.alpha * distance_m / in_all_m * focal_px;
        const int reach = static_cast<int>(std::min(1 + blur_px, kMax_px));
        const int width = tile.box.x1 - tile.box.x0, height = tile.box.y1 - tile.box.y0;
        const int x = static_cast<int>(mirror.pixel) % width, y = static_cast<int>(mirror.pixel) / width;
        for (int row = std::max(0, y - reach); row <= std::min(height - 1, y + reach); ++row)
            for (int column = std::max(0, x - reach); column <= std::min(width - 1, x + reach); ++column)
                near_part_[static_cast<std::size_t>(row * width + column)] = true;
    }

    // Joins the hit of one of many rays, the last of these shading points, to a similar one of the same
    // pixel, so that it is shaded once. Only a few are compared, because a shadow's edge may pass between
    // them. Returns false if none is similar.
    static bool join(const NextRay& ray, ShadingPoint* found, std::size_t first, std::size_t last) {
        constexpr float kMaxBrighter = 8;
        const ShadingPoint& at = found[last];
        // A lobe turns by twice the facet's angle: half of alpha, up to 10 degrees.
        constexpr float kLeansAlike = 0.985f, kOfAlpha = 0.5f;
        const float alpha = kOfAlpha * at.surface.alpha;
        const float least =
            at.surface.material->has_facets() ? std::max(kLeansAlike, 1 - 0.5f * alpha * alpha) : kLeansAlike;
        for (std::size_t i = last; i-- > first;) {
            ShadingPoint& other = found[i];
            if (other.object != at.object || other.surface_number != at.surface_number ||
                max_component(other.throughput) > (kMaxBrighter - 0.5f) * max_component(ray.throughput) ||
                other.back != at.back || other.sun_visibility != at.sun_visibility ||
                other.surface.base.bin != at.surface.base.bin || dot(other.normal, at.normal) < least)
                continue;
            other.throughput += ray.throughput;
            return true;
        }
        return false;
    }

    // Traces the chosen rays. Hits become the next wave's shading points (none after the last); the others
    // see the background.
    std::size_t follow(Tile& tile, std::size_t ray_count, bool last) {
        const FrameContext& frame = tile.frame;
        HitPacket own_hits;
        std::size_t found = 0, count = 0;
        const std::size_t mirrors = last ? 0 : trace_mirrors(tile, ray_count);
        auto marked = static_cast<std::size_t>(
            std::count_if(next_.begin(), next_.begin() + static_cast<std::ptrdiff_t>(mirrors),
                          [&](const NextRay& ray) { return near_part_[ray.from->pixel]; }));
        std::size_t room = kMaxRays - ray_count;
        for (std::size_t first = 0; first < ray_count; first += count) {
            count = std::min<std::size_t>(kPacketSize, (first < mirrors ? mirrors : ray_count) - first);
            const HitPacket& hits = first < mirrors
                                        ? mirror_hits_[first / kPacketSize]
                                        : trace_packet(tile, first, count, Coherence::kIncoherent, own_hits);
            for (std::size_t k = 0; k < count; ++k) {
                const NextRay& ray = next_[first + k];
                if (first < mirrors && near_part_[ray.from->pixel]) {
                    // Each gets an equal part of the remaining room.
                    room -= follow_many(tile, ray, room / marked--, found);
                    continue;
                }
                if (!meets_object(frame, hits, k, ray.origin_m, ray.dir)) {
                    if (ray.sees_bodies) add_background(tile, ray);
                    continue;
                }
                if (ray.glossy) ray.glossy->set_met(ray.origin_m + hits.distance[k] * ray.dir);
                if (!last && add_met(frame, hits, k, ray, found)) ++found;
            }
        }
        std::swap(current_, following_);
        return found;
    }
};

}  // namespace

std::unique_ptr<PathModel> make_traced_paths() { return std::make_unique<TracedPaths>(false); }
std::unique_ptr<PathModel> make_cached_paths() { return std::make_unique<TracedPaths>(true); }

}  // namespace hilcam
