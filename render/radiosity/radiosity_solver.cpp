#include "render/radiosity/radiosity_solver.h"

#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

// Adds the radiance of a sender's facet lobe towards a receiver: the mean over its points, each with its
// normal and weighted by its visibility.
void add_lobe(const ProbeSender& from, Vec3f dir, Vec3f source_dir, Spectrum& radiance) {
    const float io = -dot(dir, source_dir);
    const float inverse = 1 / std::sqrt(std::max(2 + 2 * io, 1e-6f)), ih = 0.5f / inverse;
    float sum = 0, seen = 0;
    for (std::size_t p = 0; p < from.lit.count; ++p) {
        const float facing = -dot(unpack_normal(from.lit.normal[p]), dir);
        if (facing <= 0) continue;
        const float no = std::max(facing, 1e-2f), ni = std::max(from.lit.cosine[p], 1e-3f);
        seen += no;
        if (!(from.lit.received[p] > 0)) continue;
        const float nh = std::min((no + ni) * inverse, 1.0f);
        sum +=
            no * from.lit.received[p] * ggx_distribution(from.alpha, nh) * ggx_visibility(from.alpha, no, ni);
    }
    if (!(sum > 0)) return;
    const float law = sum / seen;
    // Schlick's term: F0 + (1 - F0) w.
    const float grazing = schlick_weight(ih);
    radiance += (law * (1 - grazing)) * from.lobe.unpacked();
    for (float& bin : radiance.bin) bin += law * grazing * from.gain;
}

Spectrum at_least_zero(Spectrum s) {
    for (float& bin : s.bin) bin = std::max(bin, 0.0f);
    return s;
}

// Returns the direction of a source seen from an object. A lamp's direction is that from the object's origin;
// it differs only a little between probes.
Vec3f direction_to(const RadiositySource& source) {
    const bool lamp = source.kind == RadiositySource::Kind::kLamp && length(source.position_m) > 0;
    return lamp ? normalized(source.position_m) : source.dir;
}

}  // namespace

RadiositySolver::RadiositySolver(std::span<const IrradianceCache* const> lights, const EmbreeScene& scene)
    : lights_(lights.begin(), lights.end()), senders_(lights, scene) {
    const std::size_t probes = senders_.count();
    radiosity_.resize(probes), brought_.resize(probes), first_.resize(probes), sends_on_.resize(probes),
        by_lobes_.resize(probes), second_.resize(probes), first_second_.resize(probes), now_.resize(probes),
        before_.resize(probes);
    // Reserves addresses for the largest number; pages are used only as needed.
    second_along_.resize(lights_.size());
    for (std::size_t i = 0; i < lights_.size(); ++i)
        if (lights_[i]) second_along_[i].reserve(lights_[i]->entries_along());
    if (std::any_of(lights_.begin(), lights_.end(),
                    [](const IrradianceCache* light) { return light && light->throws_sun(); }))
        mirrored_.resize(probes);
}

Spectrum RadiositySolver::unmirrored(const std::vector<Spectrum>& irradiance, std::size_t n) const {
    return at_least_zero(irradiance[n] + -1.0f * mirrored_[n]);
}

void RadiositySolver::solve(std::span<const Member> group) {
    for (const Member& member : group) senders_.light(member);
    for (const Member& member : group) gather_first(member, group);
    for (const Member& member : group) gather_second(member);
    bounce(group);
    for (const Member& member : group) smooth(member), store(member);
}

void RadiositySolver::gather_first(const Member& member, std::span<const Member> group) {
    const IrradianceCache& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const std::size_t base = senders_.first(member.object);
    const Vec3f source_dir = direction_to(member.source);
    RadiositySolution& out = *member.out;
    const bool keeps_along = member.source.kind == RadiositySource::Kind::kSun;
    if (keeps_along) out.along_links.resize(member.links->size());
    // Returns the source's direction from the object that a link leads to.
    const auto source_of = [&](std::size_t object) {
        for (const Member& other : group)
            if (other.object == object) return direction_to(other.source);
        return Vec3f{};
    };
    const auto is_narrow = [&](const InterObjectLinks::Link& link) {
        const IrradianceCache& other = *lights_[link.object];
        return other.material(other.table().probes().probes()[link.probe].surface).ggx_alpha <
               kMinCachedAlpha;
    };
    for_probes(table.size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            const std::uint32_t first_along = light.first_along(n);
            PackedSpectrum* along = keeps_along && first_along != IrradianceCache::kNoLobe
                                        ? out.along.data() + first_along
                                        : nullptr;
            const IrradianceCache::Local axes = light.axes(n);
            const auto direction = [&](std::size_t d) { return axes.body(light.local_direction(d)); };
            Spectrum sum, mirrored;
            Brought brought;
            const auto add = [&](const Spectrum& radiance) {
                const float bright = max_component(radiance);
                sum += radiance;
                brought += {bright, bright * bright};
            };
            for (const TransferTable::Entry e : table.entries(n)) {
                if (!senders_.shines(base + e.probe)) {
                    if (along) *along++ = {};
                    continue;
                }
                const ProbeSender& from = senders_[base + e.probe];
                Spectrum radiance = from.diffuse.unpacked();
                if (from.alpha > 0)
                    add_lobe(from, direction(e.direction), source_dir,
                             keeps_along && light.throws_sun(e.probe) ? mirrored : radiance);
                if (along) *along++ = PackedSpectrum(radiance);
                add(radiance);
            }
            const std::span<const InterObjectLinks::Link> links = member.links->of(n);
            for (std::size_t i = 0; i < links.size(); ++i) {
                const InterObjectLinks::Link& link = links[i];
                const ProbeSender& from = senders_[senders_.first(link.object) + link.probe];
                Spectrum radiance = from.diffuse.unpacked();
                // A mirror's light is too sharp for distant directions to find; blurred, it would fall where
                // there is none.
                if (from.alpha > 0 && !is_narrow(link))
                    add_lobe(from, member.links->neighbour(link.object).dir(direction(link.direction)),
                             source_of(link.object), radiance);
                if (keeps_along) out.along_links[member.links->first(n) + i] = PackedSpectrum(radiance);
                add(radiance);
            }
            if (light.throws_sun()) {
                mirrored_[base + n] = (kPiF / static_cast<float>(table.counted(n))) * mirrored;
                sum += mirrored;
            }
            brought_[base + n] = brought;
            first_[base + n] = now_[base + n] = (kPiF / static_cast<float>(table.counted(n))) * sum;
        }
    });
}

// Bounces until little light is left, and adds the rest as a geometric series: white paint in a hollow keeps
// light for long.
void RadiositySolver::bounce(std::span<const Member> group) {
    constexpr int kMaxBounces = 64;
    constexpr double kLeft = 0.03, kMaxRatio = 0.95;
    double before = 0;
    for (int i = 0; i < kMaxBounces; ++i) {
        for (const Member& member : group) {
            const IrradianceCache& light = *lights_[member.object];
            const std::size_t base = senders_.first(member.object);
            tbb::parallel_for(Probes(0, light.table().size(), 4096), [&](const Probes& r) {
                for (std::size_t n = r.begin(); n < r.end(); ++n)
                    radiosity_[base + n] =
                        at_least_zero(light.white(n) * now_[base + n] + -1.0f * by_lobes_[base + n]);
            });
        }
        Progress step;
        for (const Member& member : group) {
            const Progress one = gather_again(member);
            step.change += one.change, step.light += one.light;
        }
        const double ratio = before > 0 ? std::min(step.change / before, kMaxRatio) : kMaxRatio;
        const double left = ratio / (1 - ratio);
        before = step.change;
        if (left * step.change > kLeft * step.light) continue;
        for (const Member& member : group) {
            const std::size_t base = senders_.first(member.object);
            tbb::parallel_for(
                Probes(base, base + lights_[member.object]->table().size(), 4096), [&](const Probes& r) {
                    for (std::size_t n = r.begin(); n < r.end(); ++n)
                        for (int b = 0; b < kMaxBins; ++b)
                            now_[n][b] +=
                                static_cast<float>(left) * std::max(0.0f, now_[n][b] - before_[n][b]);
                });
        }
        break;
    }
}

// Gathers one more bounce.
RadiositySolver::Progress RadiositySolver::gather_again(const Member& member) {
    const IrradianceCache& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const std::size_t base = senders_.first(member.object);
    // Sums that do not depend on how the work is divided.
    return tbb::parallel_deterministic_reduce(
        Probes(0, table.size(), kBlock), Progress{},
        [&](const Probes& r, Progress sum) {
            for (std::size_t n = r.begin(); n < r.end(); ++n) {
                Spectrum met;
                for (const TransferTable::Entry e : table.entries(n)) met += radiosity_[base + e.probe];
                for (const InterObjectLinks::Link& link : member.links->of(n)) met += radiosity_to(link);
                const Spectrum next = first_[base + n] + second_[base + n] +
                                      (kPiF / static_cast<float>(table.counted(n))) * met;
                // Weighted by how much of it can be seen from outside, plus a little, so that closed rooms
                // converge, too.
                const double weight = 0.01 + static_cast<double>(std::popcount(table.free(n)[0]));
                for (int b = 0; b < kMaxBins; ++b)
                    sum.change += weight * static_cast<double>(std::abs(next[b] - now_[base + n][b])),
                        sum.light += weight * static_cast<double>(next[b]);
                before_[base + n] = now_[base + n];
                now_[base + n] = next;
            }
            return sum;
        },
        [](const Progress& a, const Progress& b) {
            return Progress{a.change + b.change, a.light + b.light};
        });
}

// Leaves what is cached in before_. A probe has too few directions to resolve a small bright part: one of its
// sixty meets a lit rim, and none of its neighbour's does. Such a probe gets a mean with its neighbours, with
// a weight that grows as the effective number of directions falls (Kish's effective sample size, Survey
// Sampling, 1965, section 8.2). Light from many directions, and light of later bounces alone, stays as sharp
// as it is.
void RadiositySolver::smooth(const Member& member) {
    constexpr float kFew = 4, kMany = 1e9f;
    const IrradianceCache& light = *lights_[member.object];
    const std::size_t base = senders_.first(member.object);
    const bool subtract = member.source.kind == RadiositySource::Kind::kSun && light.throws_sun();
    const auto cached = [&](std::size_t n) { return subtract ? unmirrored(now_, base + n) : now_[base + n]; };
    for_probes(light.table().size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            const std::span<const std::uint32_t> beside = light.neighbours(n);
            const auto count = static_cast<float>(beside.size() + 1);
            Brought brought = brought_[base + n];
            Spectrum sum = cached(n);
            for (const std::uint32_t other : beside) brought += brought_[base + other], sum += cached(other);
            // Counted over all of these probes, so divided by their number.
            const float directions =
                brought.squares > 0 ? brought.sum * brought.sum / (count * brought.squares) : kMany;
            const float share = kFew / (kFew + directions);
            before_[base + n] = (1 - share) * cached(n) + (share / count) * sum;
        }
    });
}

void RadiositySolver::store(const Member& member) {
    const IrradianceCache& light = *lights_[member.object];
    const std::size_t base = senders_.first(member.object);
    RadiositySolution& out = *member.out;
    const bool keeps_along = member.source.kind == RadiositySource::Kind::kSun;
    const auto add_to = [](PackedSpectrum& sum, const Spectrum& more) {
        sum = PackedSpectrum(sum.unpacked() + more);
    };
    for_probes(light.table().size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            out.irradiance[n] = PackedSpectrum(before_[base + n]);
            if (!keeps_along) continue;
            std::size_t to = light.first_along(n), second = first_second_[base + n];
            if (to != IrradianceCache::kNoLobe)
                for (const TransferTable::Entry e : light.table().entries(n)) {
                    Spectrum more = radiosity_[base + e.probe];
                    if (sends_on_[base + e.probe]) more += second_along_[member.object][second++].unpacked();
                    add_to(out.along[to++], more);
                }
            std::size_t link_to = member.links->empty() ? 0 : member.links->first(n);
            for (const InterObjectLinks::Link& link : member.links->of(n))
                add_to(out.along_links[link_to++], radiosity_to(link));
        }
    });
}

}  // namespace hilcam
