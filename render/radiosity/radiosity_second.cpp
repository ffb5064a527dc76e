// The second step: light that has arrived directly from senders and continues by bright facet lobes.

#include <algorithm>
#include <array>
#include <cmath>

#include "render/radiosity/radiosity_solver.h"
#include "render/vocabulary/random.h"

namespace hilcam {

// Assigns the Sun's light of bright facets to lobes where that is worthwhile. Sunlight from mirrors is
// excluded, because it does not arrive along table entries.
void RadiositySolver::part_lobes(const Member& member) {
    // A hundredth of what white paint sends in the Sun. With all lobes the light between the parts of
    // geo_inspection is the same to 0.1 %, for three times the work.
    constexpr float kWorthIt = 0.01f / kPiF;
    const IrradianceCache& light = *lights_[member.object];
    const std::size_t base = senders_.first(member.object);
    const bool keeps_along = member.source.kind == RadiositySource::Kind::kSun;
    for_probes(light.table().size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            sends_on_[base + n] = 0, by_lobes_[base + n] = {};
            if (!keeps_along || light.first_along(n) == IrradianceCache::kNoLobe) continue;
            const Spectrum came = light.throws_sun() ? unmirrored(first_, base + n) : first_[base + n];
            const std::uint16_t surface = light.table().probes().probes()[n].surface;
            const Spectrum sent =
                (1 / kPiF) * (light.facet_color(n, light.albedo(surface).white_lobe()) * came);
            if (max_component(sent) < kWorthIt) continue;
            sends_on_[base + n] = 1, by_lobes_[base + n] = sent;
        }
    });
}

// Numbers, probe by probe, the entries that receive light from others' lobes.
std::size_t RadiositySolver::number_second(const Member& member) {
    const IrradianceCache& light = *lights_[member.object];
    const std::uint8_t* const sends = sends_on_.data() + senders_.first(member.object);
    std::uint32_t* const first = first_second_.data() + senders_.first(member.object);
    for_probes(light.table().size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            first[n] = 0;
            if (light.first_along(n) != IrradianceCache::kNoLobe)
                for (const TransferTable::Entry e : light.table().entries(n)) first[n] += sends[e.probe];
        }
    });
    if (tbb::is_current_task_group_canceling()) return 0;  // not all are counted
    std::uint32_t sum = 0;
    for (std::size_t n = 0; n < light.table().size(); ++n) sum += std::exchange(first[n], sum);
    return sum;
}

void RadiositySolver::gather_second(const Member& member) {
    part_lobes(member);
    const IrradianceCache& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const std::size_t base = senders_.first(member.object);
    const std::span<const std::uint8_t> sends = std::span(sends_on_).subspan(base, table.size());
    if (std::find(sends.begin(), sends.end(), 1) == sends.end()) {
        std::ranges::fill(std::span(second_).subspan(base, table.size()), Spectrum{});
        return;
    }
    std::vector<PackedSpectrum>& along = second_along_[member.object];
    if (const std::size_t count = number_second(member); count > along.size()) along.resize(count);
    // The golden section of 2^32, so that a probe's points take turns (Schretter et al., Journal of Graphics
    // Tools 16(2), 2012).
    constexpr std::uint32_t kGolden = 0x9E3779B9;
    for_probes(table.size(), [&](const Probes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            const bool has_facets = light.first_along(n) != IrradianceCache::kNoLobe;
            std::size_t to = first_second_[base + n];
            Spectrum sum;
            for (const TransferTable::Entry e : table.entries(n)) {
                if (!sends_on_[base + e.probe]) continue;
                const float choice = uniform01(kGolden * static_cast<std::uint32_t>(n + e.direction));
                const Spectrum sent = sent_on(member, e.probe, choice, -light.direction(n, e.direction));
                if (has_facets) along[to++] = PackedSpectrum(sent);
                sum += sent;
            }
            second_[base + n] = (kPiF / static_cast<float>(table.counted(n))) * sum;
        }
    });
}

// Returns the radiance that a probe's facets send in a direction, of light that has arrived in the first
// step. One of its points represents all of them, chosen in proportion to its visibility from there. choice:
// 0 to 1.
Spectrum RadiositySolver::sent_on(const Member& member, std::size_t n, float choice, Vec3f to) const {
    const IrradianceCache& light = *lights_[member.object];
    const SurfaceProbe& probe = light.table().probes().probes()[n];
    std::array<float, SurfaceProbe::kPoints> facing{};
    float all = 0;
    for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p) {
        if (light.table().is_live(n, p)) facing[p] = std::max(0.0f, dot(unpack_normal(probe.normal[p]), to));
        all += facing[p];
    }
    if (!(all > 0)) return {};
    std::size_t p = 0;
    float rest = choice * all;
    for (std::size_t i = 0; i < SurfaceProbe::kPoints && rest >= 0; rest -= facing[i++])
        if (facing[i] > 0) p = i;
    const float alpha =
        std::max(light.material(probe.surface).ggx_alpha, IrradianceCache::min_alpha(light.table()));
    const IrradianceCache::Lobe lobe = light.lobe(member.out, member.links, {}, static_cast<std::uint32_t>(n),
                                                  unpack_normal(probe.normal[p]), to, alpha);
    return light.facet_color(n, light.albedo(probe.surface).lobe(facing[p])) * lobe.cached;
}

}  // namespace hilcam
