#include "render/sunlight/penumbra_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include "render/shading/sample_offsets.h"
#include "render/shading/shadow_rays.h"
#include "render/sunlight/radiance_equation.h"
#include "render/vocabulary/mixed_bits.h"

namespace hilcam {

void PenumbraSampler::add_light(Tile& tile, const SunSampler& sun) {
    ask_once(tile, sun.middle());
    ask_again(tile, sun);
    for (const Asked& a : std::span(asked_).first(count_))
        if (a.lit > 0)
            tile.add(*a.at, LightPart::kSun, a.lit < a.of ? (1 / a.lit) * a.moments : a.moments_of_all,
                     (a.lit / a.of) * a.light);
    count_ = 0;
}

void PenumbraSampler::ask_once(Tile& tile, Vec3f sun_dir) {
    const auto lit = [](Asked* const& a, const Spectrum*) { a->lit = 1; };
    {
        ShadowRays<Asked*, decltype(lit)> shadow(tile.frame, tile.stats.shadow_rays, lit);
        for (Asked& a : std::span(asked_).first(count_))
            if (!a.like) shadow.add(a.first_m, sun_dir, &a);
    }
    for (Asked& a : std::span(asked_).first(count_))
        if (a.like) a.lit = a.like->lit;
}

// Returns the earlier shading point whose first ray also decides for this one: a layer of the same coverage
// map in the same pixel, seen by the same samples in the same plane. Things that hide the Sun are in front of
// all layers, except for what layers do to each other, which is in ShadingPoint::sunlit.
const PenumbraSampler::Asked* PenumbraSampler::layer_below(const Asked& a) const {
    if (count_ < 2) return nullptr;
    const Asked& before = asked_[count_ - 2];
    const ShadingPoint &here = *a.at, &there = *before.at;
    const bool layers = here.pixel == there.pixel && here.samples == there.samples && here.samples != 0 &&
                        here.object == there.object && here.geometric_normal == there.geometric_normal;
    if (!layers) return nullptr;
    return before.like ? before.like : &before;
}

void PenumbraSampler::ask_again(Tile& tile, const SunSampler& sun) {
    const auto width = static_cast<std::uint32_t>(tile.box.x1 - tile.box.x0);
    const float per_white = 1 / tile.white_paint(tile.frame.background->sun_irradiance_w_m2_um());
    for (Asked& a : std::span(asked_).first(count_))
        a.whites = per_white * max_component(a.light), a.kind = kind_of(*a.at);
    const auto gets_through = [](const Use& use, const Spectrum*) {
        use.asked->lit += 1;
        use.asked->moments += use.moments;
    };
    Answers found;
    for (std::size_t i = 0; i < kRounds.size(); ++i) {
        add_answers(width, found);
        const Answers near = widened(found);
        const auto at_edge = [&](const Asked& a) {
            const std::uint32_t x = a.at->pixel % width, y = a.at->pixel / width;
            return (near.lit[a.kind][y] & near.dark[a.kind][y]) >> x & 1u;
        };
        const auto takes = [&](const Asked& a) {
            if (always_has(i, a)) return !always_has(i + 1, a);
            return a.whites > kRounds[i].light && at_edge(a);
        };
        ShadowRays<Use, decltype(gets_through)> rays(tile.frame, tile.stats.shadow_rays, gets_through);
        for (Asked& a : std::span(asked_).first(count_))
            if (takes(a)) ask(kRounds[i].rays, tile, sun, a, rays);
    }
}

// Sends several rays for a shading point, each with an equal share of its light, from places that its samples
// see. With clusters, systematic sampling over the sum of their light chooses the cluster of each ray.
template <class Rays>
void PenumbraSampler::ask(float count, const Tile& tile, const SunSampler& sun, Asked& a, Rays& rays) {
    const ShadingPoint& at = *a.at;
    const auto width = static_cast<std::uint32_t>(tile.box.x1 - tile.box.x0);
    // The four pixels of a square use different places of the disk.
    const std::uint32_t in_square = at.pixel % width % 2 + 2 * (at.pixel / width % 2);
    const SampleOffsets way(tile, at);
    // Samples that no ray has started from, and those of them that are far from where rays have started.
    std::array<SampleMask, ClusterLight::kStarts> unused{}, left{};
    const float light = std::accumulate(a.shares.begin(), a.shares.end(), 0.0f);
    std::size_t k = 0;
    float until = a.shares[0];  // sum of shares up to this cluster
    a.lit = 0, a.of = count, a.moments = {};
    for (std::uint32_t i = 0; static_cast<float>(i) < count; ++i) {
        while ((static_cast<float>(i) + 0.5f) * light > until * count && k + 1 < a.shares.size())
            until += a.shares[++k];
        const NormalCluster* const cluster = a.clusters[k];
        Vec3f start_m = a.first_m;
        SubpixelMoments moments = at.moments;
        if (const SampleMask seen_by = cluster ? cluster->seen_by : at.samples; seen_by != 0) {
            if (unused[k] == 0) unused[k] = seen_by;
            const int sample = next_sample_across(tile.frame.samples, left[k], unused[k]);
            unused[k] &= ~(SampleMask{1} << sample);
            const Vec2f at_px = tile.frame.samples.place(sample);
            moments = subpixel_moments_at(at_px.x, at_px.y);
            start_m = cluster ? way.on(*cluster, sample) : start_m + way.to(sample);
        }
        rays.add(start_m, sun.on_disk(4 * i + in_square, 4 * static_cast<std::uint32_t>(count)),
                 {&a, moments});
    }
}

// Returns the kind of a shading point: an object's surface and one of six facing directions, as one of
// kKinds.
std::uint8_t PenumbraSampler::kind_of(const ShadingPoint& at) {
    const Vec3f size{std::abs(at.normal.x), std::abs(at.normal.y), std::abs(at.normal.z)};
    std::uint32_t side = at.normal.z > 0 ? 0 : 1;
    if (size.x > size.y && size.x > size.z)
        side = at.normal.x > 0 ? 2 : 3;
    else if (size.y > size.z)
        side = at.normal.y > 0 ? 4 : 5;
    return static_cast<std::uint8_t>(
        mixed(std::uint64_t{at.object} << 32 | std::uint64_t{at.surface_number} << 3 | side) % kKinds);
}

// Adds the answers of the last rays.
void PenumbraSampler::add_answers(std::uint32_t width, Answers& to) const {
    for (const Asked& a : std::span(asked_).first(count_)) {
        const std::uint32_t y = a.at->pixel / width, x = 1u << (a.at->pixel % width);
        if (a.lit > 0) to.lit[a.kind][y] |= x, to.lit_kinds |= 1u << a.kind;
        if (a.lit < a.of) to.dark[a.kind][y] |= x, to.dark_kinds |= 1u << a.kind;
    }
}

// Returns the answers within reach of each pixel, for kinds that differ somewhere; none for the others.
PenumbraSampler::Answers PenumbraSampler::widened(const Answers& of) {
    Answers near;
    for (std::uint32_t rest = of.lit_kinds & of.dark_kinds; rest != 0; rest &= rest - 1) {
        const auto kind = static_cast<std::size_t>(std::countr_zero(rest));
        near.lit[kind] = widened(of.lit[kind]), near.dark[kind] = widened(of.dark[kind]);
    }
    return near;
}

// Returns the pixels with one of these within reach.
PenumbraSampler::Rows PenumbraSampler::widened(const Rows& rows) {
    Rows out{};
    for (int y = 0; y < kMaxRows; ++y) {
        const std::uint32_t row = rows[static_cast<std::size_t>(y)];
        std::uint32_t across = row;
        for (int i = 1; i <= kReach_px; ++i) across |= row << i | row >> i;
        const int last = std::min(kMaxRows - 1, y + kReach_px);
        for (int near = std::max(0, y - kReach_px); near <= last; ++near)
            out[static_cast<std::size_t>(near)] |= across;
    }
    return out;
}

}  // namespace hilcam
