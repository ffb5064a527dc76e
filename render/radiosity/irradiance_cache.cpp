#include "render/radiosity/irradiance_cache.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/radiosity/inter_object_links.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

bool all_of(std::span<const std::uint64_t> words, int directions) {
    int free = 0;
    for (const std::uint64_t word : words) free += std::popcount(word);
    return free == directions;
}

IrradianceCache::Bounds sphere_about(std::span<const SurfaceProbe> probes) {
    if (probes.empty()) return {};
    Vec3f least = probes[0].point_m[0], most = least;
    for (const SurfaceProbe& probe : probes)
        for (const Vec3f p : probe.point_m) {
            least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
            most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
        }
    return {0.5f * (least + most), 0.5f * length(most - least)};
}

}  // namespace

ObjectAlbedos::ObjectAlbedos(const ObjectSurfaces& surfaces, const MeshView& mesh,
                             const SurfaceProbes& probes, float min_alpha)
    : neighbours(probes.neighbours()) {
    std::vector<float> throws;
    for (const Material& material : surfaces.materials) {
        own.emplace_back(material);
        Material other = material;
        other.ggx_alpha = std::max(material.ggx_alpha, min_alpha);
        wide.emplace_back(other);
        const bool is_mirror =
            material.has_facets() && material.ggx_alpha < kMinCachedAlpha && !material.varies();
        throws.push_back(is_mirror ? max_component(own.back().lobe(0.5f)) : 0.0f);
    }
    mirrors = find_flat_mirrors(mesh, surfaces, throws);
}

// A lobe's half width is about twice its alpha; sixty directions are 0.32 rad apart.
float IrradianceCache::min_alpha(const TransferTable& table) {
    return 1.16f / std::sqrt(static_cast<float>(table.directions()));
}

IrradianceCache::IrradianceCache(const ShownObject& object, std::shared_ptr<const ObjectAlbedos> albedos,
                                 const ColorBands& bands, float step_rad)
    : shown_(&object), table_(object.transfer), albedos_(std::move(albedos)), step_rad_(step_rad) {
    const std::vector<Material>& materials = object.materials();
    for (const Material& material : materials) materials_.push_back(&material);
    for (const Vec3f d : transfer_directions(table_->directions()))
        local_x_.push_back(d.x), local_y_.push_back(d.y), local_z_.push_back(d.z),
            per_cosine_.push_back(1 / d.z);
    while (per_cosine_.size() % kDirectionLanes != 0)
        local_x_.push_back(0), local_y_.push_back(0), local_z_.push_back(1), per_cosine_.push_back(0);

    const std::vector<SurfaceProbe>& probes = table_->probes().probes();
    const bool textured =
        std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.varies(); });
    for (std::size_t n = 0; n < probes.size(); ++n) {
        const Material& material = *materials_[probes[n].surface];
        Spectrum lobe = albedos_->own[probes[n].surface].white_lobe(),
                 base = albedos_->own[probes[n].surface].white_base();
        if (textured) {
            colors_.push_back(Spectrum{});
            colors_.back().bin.fill(1);
            if (material.varies()) colors_.back() = bands.spectrum(probes[n].color);
            base = base * colors_.back();
        }
        lobe = facet_color(n, lobe);
        white_.emplace_back((1 / kPiF) * (base + lobe));
        describe_lobe(n);
    }
    bounds_ = sphere_about(probes);
    find_what_throws();
}

void IrradianceCache::find_what_throws() {
    if (mirrors().empty()) return;
    const std::vector<SurfaceProbe>& probes = table_->probes().probes();
    throws_sun_.resize(probes.size());
    for (std::size_t n = 0; n < probes.size(); ++n)
        for (const FlatMirror& mirror : mirrors())
            if (mirror.surface == probes[n].surface &&
                mirror.holds(probes[n].point_m[0], unpack_normal(probes[n].geometric[0])))
                throws_sun_[n] = 1;
}

void IrradianceCache::describe_lobe(std::size_t n) {
    const TransferTable& table = *table_;
    const SurfaceProbe& probe = table.probes().probes()[n];
    const auto of_32767 = [](float x) { return static_cast<std::int16_t>(std::lround(32767 * x)); };
    LobeProbe lobe{};
    lobe.normal = probe.mean_normal;
    lobe.turn = {of_32767(table.turn(n).x), of_32767(table.turn(n).y)};
    lobe.first_entry = table.first_entry(n);
    lobe.entries = static_cast<std::uint16_t>(table.entries(n).size());
    lobe.counted = static_cast<std::uint16_t>(table.counted(n));
    lobe.free = table.free(n)[0];
    lobe.all_free = all_of(table.free(n), table.directions());
    for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p)
        lobe.live = static_cast<std::uint8_t>(lobe.live | table.is_live(n, p) << p);
    // Curved surfaces widen lobes, so a lookup may ask for any alpha.
    lobe.first_along = kNoLobe;
    if (materials_[probe.surface]->has_facets()) {
        lobe.first_along = static_cast<std::uint32_t>(along_);
        along_ += lobe.entries;
    }
    lobes_.push_back(lobe);
}

std::size_t IrradianceCache::add_term(RadiositySource::Kind kind) {
    terms_.push_back(make_solution(kind));
    terms_.back().irradiance = {};
    irradiance_.assign(terms_.size() * table_->size(), {});
    return terms_.size() - 1;
}

RadiositySolution IrradianceCache::make_solution(RadiositySource::Kind kind) const {
    RadiositySolution out;
    out.irradiance.resize(table_->size());
    if (kind == RadiositySource::Kind::kSun) out.along.resize(along_);
    if (kind == RadiositySource::Kind::kCone) out.seen.resize(table_->size());
    return out;
}

void IrradianceCache::adopt(std::size_t t, RadiositySolution& solution) {
    RadiositySolution& term = terms_[t];
    std::swap(term.along, solution.along), std::swap(term.along_links, solution.along_links);
    std::swap(term.seen, solution.seen);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, table_->size(), 4096), [&](const auto& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n)
            irradiance_[n * terms_.size() + t] = solution.irradiance[n];
    });
}

void IrradianceCache::adopt(const InterObjectLinks& links) {
    links_ = &links;
    for (std::size_t n = 0; n < lobes_.size(); ++n) {
        const std::span<const std::uint64_t> free = links.free(*table_, n);
        lobes_[n].free = free[0];
        lobes_[n].all_free = all_of(free, table_->directions());
    }
}

std::size_t IrradianceCache::bytes() const {
    std::size_t bytes = colors_.size() * sizeof(Spectrum) + lobes_.size() * sizeof(LobeProbe) +
                        throws_sun_.size() + (white_.size() + irradiance_.size()) * sizeof(PackedSpectrum);
    for (const RadiositySolution& term : terms_) bytes += term.bytes();
    return bytes + albedos_->neighbours.bytes() + (links_ ? links_->bytes() : 0);
}

IrradianceCache::Local IrradianceCache::local(const LobeProbe& probe) {
    constexpr float kWhole = 1 / 32767.0f;
    return {Frame(unpack_normal(probe.normal)),
            {kWhole * static_cast<float>(probe.turn[0]), kWhole * static_cast<float>(probe.turn[1])}};
}

}  // namespace hilcam
