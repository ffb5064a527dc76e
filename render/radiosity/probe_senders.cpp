#include "render/radiosity/probe_senders.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "render/scene/lamp.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

// A cone's directions, sixteen of equal solid angle (Vogel 1979), for the irradiance that it makes.
constexpr int kConeDirections = 16;
std::array<Vec3f, kConeDirections> cone_directions(Vec3f axis_dir, float cone_cosine) {
    const Frame axis(axis_dir);
    std::array<Vec3f, kConeDirections> out;
    for (int i = 0; i < kConeDirections; ++i) {
        const float below = (static_cast<float>(i) + 0.5f) / kConeDirections * (1 - cone_cosine);
        const float r = std::sqrt(std::max(0.0f, below * (2 - below))),
                    phi = 2 * kPiF * 0.61803399f * static_cast<float>(i);
        out[static_cast<std::size_t>(i)] = axis.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
    }
    return out;
}

}  // namespace

ProbeSenders::ProbeSenders(std::span<const IrradianceCache* const> lights, const EmbreeScene& scene)
    : lights_(lights.begin(), lights.end()), scene_(scene) {
    std::size_t probes = 0;
    for (const IrradianceCache* light : lights_) {
        base_.push_back(probes);
        if (light) probes += light->table().size();
    }
    senders_.resize(probes), shines_.resize(probes);
}

void ProbeSenders::light(const RadiosityMember& member) {
    using Probes = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(
        Probes(0, lights_[member.object]->table().size(), kBlock),
        [&](const Probes& r) { light_block(member, r.begin(), r.end()); }, tbb::simple_partitioner{});
}

// Returns which rays are blocked by the object itself or by a near one.
std::uint32_t ProbeSenders::blocked(const RadiosityMember& member, const RayPacket& rays) const {
    std::uint32_t out = scene_.occluded_by(member.object, rays);
    for (const NeighbourObject& other : member.links->near()) {
        RayPacket there = rays;
        bool any = false;
        for (int i = 0; i < rays.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Vec3f origin = other.place({rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]});
            const Vec3f dir = other.dir({rays.dir_x[k], rays.dir_y[k], rays.dir_z[k]});
            there.set(i, origin, dir, rays.nearest[k], rays.farthest[k]);
            any = any || lights_[other.object]->bounds().is_met(origin, dir);
        }
        if (any) out |= scene_.occluded_by(other.object, there);
    }
    return out;
}

void ProbeSenders::light_block(const RadiosityMember& member, std::size_t first, std::size_t last) {
    const IrradianceCache& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const RadiositySource& source = member.source;
    ProbeSender* const senders = senders_.data() + base_[member.object];
    std::array<LitPoints, kBlock> lit;
    RayPacket rays;
    std::array<float*, kPacketSize> of;  // result of each ray
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count == 0) return;
        const std::uint32_t stopped = this->blocked(member, rays);
        for (int i = 0; i < rays.count; ++i)
            if (stopped >> i & 1u) *of[static_cast<std::size_t>(i)] = 0;
        rays.count = 0;
    };
    const bool cone = source.kind == RadiositySource::Kind::kCone;
    const auto cone_dirs = cone_directions(source.dir, cone ? source.cone_cosine : 1);
    for (std::size_t n = first; n < last; ++n) {
        LitPoints& points = lit[n - first];
        if (source.kind == RadiositySource::Kind::kGlow) continue;
        const SurfaceProbe& probe = table.probes().probes()[n];
        for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p) {
            if (!table.is_live(n, p)) continue;
            const std::size_t place = points.count++;
            points.normal[place] = probe.normal[p];
            const Vec3f normal = unpack_normal(probe.normal[p]),
                        geometric = unpack_normal(probe.geometric[p]);
            Vec3f dir = source.dir;
            float strength = 1, until_m = std::numeric_limits<float>::infinity();
            if (source.kind == RadiositySource::Kind::kLamp) {
                const Vec3f way = source.position_m - probe.point_m[p];
                const float distance_m = std::max(length(way), 1e-3f);
                dir = way / distance_m;
                strength = static_cast<float>(source.beam->at(to_double(source.dir), to_double(-dir))) /
                           (distance_m * distance_m);
                until_m = std::max(0.0f, distance_m * (1 - 1e-5f) - static_cast<float>(kLampClearance_m));
            }
            float cosine = std::max(0.0f, dot(normal, dir));
            if (cone) {
                float sum = 0, faced = 0;
                for (const Vec3f d : cone_dirs) {
                    sum += std::max(0.0f, dot(normal, d));
                    faced += std::max(0.0f, dot(source.dir, d));
                }
                cosine = sum / faced;
            }
            if (cosine * strength <= 0 || (!cone && dot(geometric, dir) <= 0)) continue;
            points.cosine[place] = cosine, points.received[place] = cosine * strength;
            if (cone) continue;
            of[static_cast<std::size_t>(rays.count)] = &points.received[place];
            rays.set(rays.count, probe.point_m[p], dir, 0, until_m);
            if (++rays.count == kPacketSize) flush();
        }
    }
    flush();
    for (std::size_t n = first; n < last; ++n) {
        LitPoints& points = lit[n - first];
        if (cone) {
            const float share = seen_of_cone(member, light, n);
            member.out->seen[n] = static_cast<std::uint8_t>(std::lround(255 * share));
            for (float& received : points.received) received *= share;
        }
        ProbeSender& sender = senders[n];
        send(light, n, points, sender);
        if (source.kind == RadiositySource::Kind::kGlow)
            sender.diffuse =
                PackedSpectrum(light.material(table.probes().probes()[n].surface).emission.mean());
        if (cone && sender.alpha > 0) widen(light, n, source, sender);
        shines_[base_[member.object] + n] = sender.alpha > 0 || sender.diffuse.greatest() > 0;
    }
}

// A wide source widens lobes. Those wider than half a radian send all their light like paint.
void ProbeSenders::widen(const IrradianceCache& light, std::size_t n, const RadiositySource& source,
                         ProbeSender& sender) {
    constexpr float kBegins = 0.2f, kWhole = 0.4f;
    const float sine = std::sqrt(std::max(0.0f, 1 - source.cone_cosine * source.cone_cosine));
    sender.alpha = std::min(1.0f, std::hypot(sender.alpha, 0.5f * sine));
    const float paint = std::clamp((sender.alpha - kBegins) / (kWhole - kBegins), 0.0f, 1.0f);
    if (paint == 0) return;
    const float received = sender.lit.mean();
    const Spectrum albedo = light.facet_color(
        n, light.albedo(light.table().probes().probes()[n].surface).lobe(sender.lit.mean_cosine()));
    sender.diffuse = PackedSpectrum(sender.diffuse.unpacked() + (paint * received / kPiF) * albedo);
    sender.lobe = PackedSpectrum((1 - paint) * sender.lobe.unpacked());
    sender.gain *= 1 - paint;
    if (paint == 1) sender.alpha = 0;
}

void ProbeSenders::send(const IrradianceCache& light, std::size_t n, const LitPoints& lit,
                        ProbeSender& sender) {
    sender = {};
    const float received = lit.mean();
    if (!(received > 0)) return;
    const float cosine = lit.mean_cosine();
    const std::uint16_t surface = light.table().probes().probes()[n].surface;
    const Material& material = light.material(surface);
    const MaterialAlbedo& albedo = light.albedo(surface);
    sender.diffuse = PackedSpectrum(light.colored(n, (received / kPiF) * albedo.base(cosine)));
    if (!material.has_facets()) return;
    sender.lit = lit;
    sender.alpha = std::max(material.ggx_alpha, IrradianceCache::min_alpha(light.table()));
    // Whatever width is used for the facets, they send in total what they reflect.
    const float whole = max_component(light.wide_albedo(surface).lobe(cosine));
    sender.gain = whole > 0 ? max_component(albedo.lobe(cosine)) / whole : 0.0f;
    sender.lobe = PackedSpectrum(sender.gain * light.facet_color(n, material.highlight));
}

float ProbeSenders::seen_of_cone(const RadiosityMember& member, const IrradianceCache& light, std::size_t n) {
    const TransferTable& table = light.table();
    const std::span<const std::uint64_t> is_free = member.links->free(table, n);
    const ConeShare cone(light.axes(n).dir(member.source.dir), member.source.cone_cosine, table.directions());
    float all = 0, free = 0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(table.directions()); ++d) {
        if (!table.is_live(n, table.point_of(d))) continue;
        const Vec3f dir = light.local_direction(d);
        const float in = cone.of(dir.x, dir.y, dir.z);
        all += in;
        if (is_free[d / 64] >> (d % 64) & 1u) free += in;
    }
    return all > 0 ? free / all : 0;
}

}  // namespace hilcam
