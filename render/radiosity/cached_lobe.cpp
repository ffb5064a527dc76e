// The lookup of an IrradianceCache by a facet lobe.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "render/radiosity/inter_object_links.h"
#include "render/radiosity/irradiance_cache.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/lane_sum.h"

namespace hilcam {
namespace {

// A lobe in a probe's axes, and the sums of its weights.
struct LobeQuery {
    GgxLobe law;
    Vec3f normal, view, mirror;
    bool narrow;
    float whole = 0, cached = 0;
};

// Sums every sixteenth value. Vectors are written out because GCC 12 keeps sums in memory, where each waits
// for the one before. n is a multiple of kDirectionLanes.
[[gnu::always_inline]] inline std::array<float, kDirectionLanes> sums_by_lane(const float* value,
                                                                              std::size_t n) {
    using Eight [[gnu::vector_size(32)]] = float;
    std::array<Eight, kDirectionLanes / 8> sums = {};
    for (std::size_t d = 0; d < n; d += kDirectionLanes)
        for (std::size_t k = 0; k < sums.size(); ++k) {
            Eight values;
            std::memcpy(&values, value + d + 8 * k, sizeof values);
            sums[k] += values;
        }
    std::array<float, kDirectionLanes> out;
    std::memcpy(out.data(), sums.data(), sizeof out);
    return out;
}

// Computes the weight of each direction. `whole`: in the lobe without Fresnel's term; `cached`: without the
// part of a narrow lobe that rays follow. Directions are distributed like the cosine to the probe's normal,
// so for a surface with another normal each is weighted by the ratio of both cosines (importance sampling:
// Pharr et al., Physically Based Rendering, 3rd ed., section 13.10). per_cosine: one over the probe's cosine;
// 0 for padding. n is a multiple of kDirectionLanes.
HILCAM_CLONES
void lobe_weights(const float* x, const float* y, const float* z, const float* per_cosine, std::size_t n,
                  LobeQuery& query, float* whole, float* cached) {
    // A narrow lobe's tails begin 15 degrees from the mirror direction and are complete at 30.
    constexpr float kNone = 0.966f, kWhole = 0.866f;
    const Vec3f m = query.normal, v = query.view, r = query.mirror;
    const GgxLobe law = query.law;
    for (std::size_t d = 0; d < n; ++d) {
        const float ni = x[d] * m.x + y[d] * m.y + z[d] * m.z;
        const float io = x[d] * v.x + y[d] * v.y + z[d] * v.z;
        whole[d] = (ni > 0 ? ni * per_cosine[d] : 0.0f) * law.at(std::max(ni, 1e-3f), io);
    }
    if (query.narrow)
        for (std::size_t d = 0; d < n; ++d) {
            const float off = x[d] * r.x + y[d] * r.y + z[d] * r.z;
            cached[d] = whole[d] * std::min(std::max((kNone - off) * (1 / (kNone - kWhole)), 0.0f), 1.0f);
        }
    else
        std::copy_n(whole, n, cached);
    const auto wholes = sums_by_lane(whole, n), cached_sums = sums_by_lane(cached, n);
    for (std::size_t i = 0; i < kDirectionLanes; ++i)
        query.whole += wholes[i], query.cached += cached_sums[i];
}

// Computes the weights of the directions in a cone, and their sum. n is a multiple of kDirectionLanes.
HILCAM_CLONES
float cone_weights(const float* x, const float* y, const float* z, const float* weight, std::size_t n,
                   const ConeShare& share, float* in_cone) {
    const ConeShare cone = share;
    for (std::size_t d = 0; d < n; ++d) in_cone[d] = weight[d] * cone.of(x[d], y[d], z[d]);
    return lane_sum(sums_by_lane(in_cone, n));
}

// The light that directions bring, summed for Lobe::directions.
struct Brought {
    float sum = 0, squares = 0;
    void add(float light) { sum += light, squares += light * light; }
    float directions() const { return squares > 0 ? sum * sum / squares : 0.0f; }
};

}  // namespace

void IrradianceCache::prefetch_along(std::size_t t, std::uint32_t n) const {
    const LobeProbe& probe = lobes_[n];
    if (probe.entries == 0) return;
    const auto ask_for = [&](const auto* first) {
        constexpr std::size_t kLine = 64 / sizeof(*first);
        for (std::size_t i = 0; i < probe.entries; i += kLine) __builtin_prefetch(first + i);
    };
    ask_for(table_->entry(probe.first_entry));
    if (t != kNoTerm && probe.first_along != kNoLobe) ask_for(terms_[t].along.data() + probe.first_along);
}

IrradianceCache::Lobe IrradianceCache::lobe(std::size_t sun, std::span<const Cone> cones, std::uint32_t n,
                                            Vec3f normal, Vec3f view_dir, float alpha) const {
    if (lobes_[n].all_free) return {};
    return lobe(sun == kNoTerm ? nullptr : &terms_[sun], links_, cones, n, normal, view_dir, alpha);
}

IrradianceCache::Lobe IrradianceCache::lobe(const RadiositySolution* sun, const InterObjectLinks* links,
                                            std::span<const Cone> cones, std::uint32_t n, Vec3f normal,
                                            Vec3f view_dir, float alpha) const {
    const LobeProbe& probe = lobes_[n];
    const Local axes = local(probe);
    LobeQuery query{.law = {alpha, std::max(dot(normal, view_dir), 1e-2f)},
                    .normal = axes.dir(normal),
                    .view = axes.dir(view_dir),
                    .mirror = axes.dir(reflect(view_dir, normal)),
                    .narrow = alpha < kMinCachedAlpha};
    alignas(64) std::array<float, kMaxDirections> whole, cached;  // weights, by direction
    lobe_weights(local_x_.data(), local_y_.data(), local_z_.data(), per_cosine_.data(), per_cosine_.size(),
                 query, whole.data(), cached.data());
    // Buried points do not count.
    const std::size_t of_point = table_->directions_of_point();
    for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p)
        for (std::size_t d = p * of_point; !(probe.live >> p & 1u) && d < (p + 1) * of_point; ++d) {
            query.whole -= whole[d], query.cached -= cached[d];
            whole[d] = cached[d] = 0;
        }
    Lobe out;
    if (!(query.whole > 0)) return out;
    // Sixty directions are too few to normalise a narrow lobe by their sum, but suffice for its tails.
    const float all =
        query.narrow ? static_cast<float>(probe.counted) / kPiF : std::max(query.cached, 1e-20f);
    for (std::size_t c = 0; c < cones.size(); ++c) {
        const ConeShare cone(axes.dir(cones[c].dir), cones[c].cosine, table_->directions());
        alignas(64) std::array<float, kMaxDirections> in_cone;
        const float of_cone = cone_weights(local_x_.data(), local_y_.data(), local_z_.data(), whole.data(),
                                           per_cosine_.size(), cone, in_cone.data());
        float met = 0;
        for_each_met(n, [&](std::size_t d) { met += in_cone[d]; });
        out.free[c] = of_cone > 0 ? std::clamp(1 - met / of_cone, 0.0f, 1.0f) : 0.0f;
    }
    const bool facets = sun && probe.first_along != kNoLobe;
    const PackedSpectrum* along = facets ? sun->along.data() + probe.first_along : nullptr;
    float occupied = 0;
    std::size_t met_probes = probe.entries;
    const TransferTable::Entry* const entries = table_->entry(probe.first_entry);
    std::array<float, kMaxDirections> of_entry;  // a direction meets one thing at most
    Brought brought;
    // One loop for all sums, because each waits for its own result.
    for (std::size_t i = 0; i < probe.entries; ++i) {
        occupied += of_entry[i] = cached[entries[i].direction];
        if (along) brought.add(of_entry[i] * along[i].greatest());
    }
    if (along) out.cached = PackedSpectrum::weighted_sum(along, of_entry.data(), probe.entries);
    if (links && !links->empty()) {
        const PackedSpectrum* there = sun ? sun->along_links.data() + links->first(n) : nullptr;
        for (const InterObjectLinks::Link& link : links->of(n)) {
            ++met_probes;
            occupied += cached[link.direction];
            if (!there) continue;
            brought.add(cached[link.direction] * there->greatest());
            out.cached += cached[link.direction] * (there++)->unpacked();
        }
    }
    out.cached = (1 / all) * out.cached;
    out.directions = brought.directions();
    // Light along the directions that meet something makes up the probe's irradiance: pi / counted times each
    // radiance.
    if (met_probes > 0)
        out.of_irradiance =
            occupied / all * static_cast<float>(probe.counted) / (kPiF * static_cast<float>(met_probes));
    return out;
}

// Calls visit(direction) where a probe's direction meets something, even if it is dark.
template <class Visit>
void IrradianceCache::for_each_met(std::size_t n, const Visit& visit) const {
    const auto directions = static_cast<std::size_t>(table_->directions());
    const auto word = [&](std::size_t w) {
        return links_ ? links_->free(*table_, n)[w] : table_->free(n)[w];
    };
    for (std::size_t first = 0; first < directions; first += 64) {
        const std::uint64_t free = first == 0 ? lobes_[n].free : word(first / 64);
        const std::size_t bits = std::min<std::size_t>(64, directions - first);
        std::uint64_t met = ~free & (bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1);
        for (; met != 0; met &= met - 1) visit(first + static_cast<std::size_t>(std::countr_zero(met)));
    }
}

bool IrradianceCache::is_near(std::uint32_t n, Vec3f dir) const {
    const LobeProbe& probe = lobes_[n];
    if (probe.all_free) return false;
    const Vec3f l = local(probe).dir(dir);
    bool near = false;
    for_each_met(n, [&](std::size_t d) {
        near = near || (local_x_[d] * l.x + local_y_[d] * l.y + local_z_[d] * l.z > kNear &&
                        (probe.live >> table_->point_of(d) & 1u) != 0);
    });
    return near;
}

}  // namespace hilcam
