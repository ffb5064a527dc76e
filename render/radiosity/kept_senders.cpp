// Finds what the nodes of an object send: of a source that shines on them, KeptSolver's first step, and of its light that has
// come to them by one way, which bright facets send on by their lobes.

#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/radiosity/kept_solver.h"
#include "render/scene/lamp.h"
#include "render/scene/surface.h"
#include "render/vocabulary/random.h"

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

void KeptSolver::light_nodes(const Member& member) {
    for_nodes(lights_[member.object]->table().size(),
              [&](const Nodes& r) { light_block(member, r.begin(), r.end()); });
}

// Returns which rays are blocked by the object itself, or by one that stands near.
std::uint32_t KeptSolver::blocked(const Member& member, const RayPacket& rays) const {
    std::uint32_t out = scene_.occluded_by(member.object, rays);
    for (const KeptNeighbour& other : member.links->near()) {
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

void KeptSolver::light_block(const Member& member, std::size_t first, std::size_t last) {
    const KeptLight& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const KeptSource& source = member.source;
    Sender* const senders = senders_.data() + base_[member.object];
    std::array<LitPoints, kBlock> lit;
    RayPacket rays;
    std::array<float*, kPacketSize> of;  // by ray, what it asks for
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count == 0) return;
        const std::uint32_t stopped = this->blocked(member, rays);
        for (int i = 0; i < rays.count; ++i)
            if (stopped >> i & 1u) *of[static_cast<std::size_t>(i)] = 0;
        rays.count = 0;
    };
    const bool cone = source.kind == KeptSource::Kind::kCone;
    const auto cone_dirs = cone_directions(source.dir, cone ? source.cone_cosine : 1);
    for (std::size_t n = first; n < last; ++n) {
        LitPoints& points = lit[n - first];
        if (source.kind == KeptSource::Kind::kGlow) continue;
        const LightNode& node = table.nodes().nodes()[n];
        for (std::size_t p = 0; p < LightNode::kPoints; ++p) {
            if (!table.is_live(n, p)) continue;
            const std::size_t place = points.count++;
            points.normal[place] = node.normal[p];
            const Vec3f normal = unpack_normal(node.normal[p]), geometric = unpack_normal(node.geometric[p]);
            Vec3f dir = source.dir;
            float strength = 1, until_m = std::numeric_limits<float>::infinity();
            if (source.kind == KeptSource::Kind::kLamp) {
                const Vec3f way = source.position_m - node.point_m[p];
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
            rays.set(rays.count, node.point_m[p], dir, 0, until_m);
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
        Sender& sender = senders[n];
        send(light, n, points, sender);
        if (source.kind == KeptSource::Kind::kGlow)
            sender.diffuse = PackedSpectrum(light.material(table.nodes().nodes()[n].surface).emission);
        if (cone && sender.alpha > 0) widen(light, n, source, sender);
        shines_[base_[member.object] + n] = sender.alpha > 0 || sender.diffuse.greatest() > 0;
    }
}

// A wide source widens lobes; those that are wider than half a radian send as paint does, all that they
// reflect.
void KeptSolver::widen(const KeptLight& light, std::size_t n, const KeptSource& source, Sender& sender) {
    constexpr float kBegins = 0.2f, kWhole = 0.4f;
    const float sine = std::sqrt(std::max(0.0f, 1 - source.cone_cosine * source.cone_cosine));
    sender.alpha = std::min(1.0f, std::hypot(sender.alpha, 0.5f * sine));
    const float paint = std::clamp((sender.alpha - kBegins) / (kWhole - kBegins), 0.0f, 1.0f);
    if (paint == 0) return;
    const float received = sender.lit.mean();
    const Spectrum albedo = light.facet_color(
        n, light.albedo(light.table().nodes().nodes()[n].surface).lobe(sender.lit.mean_cosine()));
    sender.diffuse = PackedSpectrum(sender.diffuse.unpacked() + (paint * received / kPiF) * albedo);
    sender.lobe = PackedSpectrum((1 - paint) * sender.lobe.unpacked());
    sender.gain *= 1 - paint;
    if (paint == 1) sender.alpha = 0;
}

void KeptSolver::send(const KeptLight& light, std::size_t n, const LitPoints& lit, Sender& sender) const {
    sender = {};
    const float received = lit.mean();
    if (!(received > 0)) return;
    const float cosine = lit.mean_cosine();
    const std::uint16_t surface = light.table().nodes().nodes()[n].surface;
    const Material& material = light.material(surface);
    const MaterialAlbedo& albedo = light.albedo(surface);
    sender.diffuse = PackedSpectrum(light.colored(n, (received / kPiF) * albedo.base(cosine)));
    if (!material.has_facets()) return;
    sender.lit = lit;
    sender.alpha = std::max(material.ggx_alpha, KeptLight::min_alpha(light.table()));
    // However wide the facets are taken, they send as much in all as they reflect.
    const float whole = largest(light.wide_albedo(surface).lobe(cosine));
    sender.gain = whole > 0 ? largest(albedo.lobe(cosine)) / whole : 0.0f;
    sender.lobe = PackedSpectrum(sender.gain * light.facet_color(n, material.highlight));
}

// Leaves to lobes what they send on of the Sun's light, where that is worth it. Not of what mirrors throw, which is not along
// the entries.
void KeptSolver::part_lobes(const Member& member) {
    // A hundredth of what white paint sends in the Sun: with all of them light between the parts of geo_inspection is the same to
    // 0.1 %, for three times the work.
    constexpr float kWorthIt = 0.01f / kPiF;
    const KeptLight& light = *lights_[member.object];
    const std::size_t base = base_[member.object];
    const bool keeps_along = member.source.kind == KeptSource::Kind::kSun;
    for_nodes(light.table().size(), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            sends_on_[base + n] = 0, by_lobes_[base + n] = {};
            if (!keeps_along || light.first_along(n) == KeptLight::kNoLobe) continue;
            const Spectrum came = light.throws_sun() ? unmirrored(first_, base + n) : first_[base + n];
            const std::uint16_t surface = light.table().nodes().nodes()[n].surface;
            const Spectrum sent =
                (1 / kPiF) * (light.facet_color(n, light.albedo(surface).white_lobe()) * came);
            if (largest(sent) < kWorthIt) continue;
            sends_on_[base + n] = 1, by_lobes_[base + n] = sent;
        }
    });
}

// Numbers what facets will have of the lobes of others, by node in order.
std::size_t KeptSolver::number_second(const Member& member) {
    const KeptLight& light = *lights_[member.object];
    const std::uint8_t* const sends = sends_on_.data() + base_[member.object];
    std::uint32_t* const first = first_second_.data() + base_[member.object];
    for_nodes(light.table().size(), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            first[n] = 0;
            if (light.first_along(n) != KeptLight::kNoLobe)
                for (const TransferTable::Entry e : light.table().entries(n)) first[n] += sends[e.node];
        }
    });
    if (tbb::is_current_task_group_canceling()) return 0;  // not all are counted
    std::uint32_t sum = 0;
    for (std::size_t n = 0; n < light.table().size(); ++n) sum += std::exchange(first[n], sum);
    return sum;
}

void KeptSolver::gather_second(const Member& member) {
    part_lobes(member);
    const KeptLight& light = *lights_[member.object];
    const TransferTable& table = light.table();
    const std::size_t base = base_[member.object];
    const std::span<const std::uint8_t> sends = std::span(sends_on_).subspan(base, table.size());
    if (std::find(sends.begin(), sends.end(), 1) == sends.end()) {
        std::ranges::fill(std::span(second_).subspan(base, table.size()), Spectrum{});
        return;
    }
    std::vector<PackedSpectrum>& along = second_along_[member.object];
    if (const std::size_t count = number_second(member); count > along.size()) along.resize(count);
    // The golden section of 2^32, so that a place's points take turns (Schretter et al., Journal of Graphics Tools 16(2), 2012).
    constexpr std::uint32_t kGolden = 0x9E3779B9;
    for_nodes(table.size(), [&](const Nodes& r) {
        for (std::size_t n = r.begin(); n < r.end(); ++n) {
            const bool has_facets = light.first_along(n) != KeptLight::kNoLobe;
            std::size_t to = first_second_[base + n];
            Spectrum sum;
            for (const TransferTable::Entry e : table.entries(n)) {
                if (!sends_on_[base + e.node]) continue;
                const float choice = uniform01(kGolden * static_cast<std::uint32_t>(n + e.direction));
                const Spectrum sent = sent_on(member, e.node, choice, -light.direction(n, e.direction));
                if (has_facets) along[to++] = PackedSpectrum(sent);
                sum += sent;
            }
            second_[base + n] = (kPiF / static_cast<float>(table.counted(n))) * sum;
        }
    });
}

// The radiance that a node's facets send in a direction of what has come to it by one way. One of its points stands for all of
// them, as often as it is seen from there. choice: 0 to 1.
Spectrum KeptSolver::sent_on(const Member& member, std::size_t n, float choice, Vec3f to) const {
    const KeptLight& light = *lights_[member.object];
    const LightNode& node = light.table().nodes().nodes()[n];
    std::array<float, LightNode::kPoints> facing{};
    float all = 0;
    for (std::size_t p = 0; p < LightNode::kPoints; ++p) {
        if (light.table().is_live(n, p)) facing[p] = std::max(0.0f, dot(unpack_normal(node.normal[p]), to));
        all += facing[p];
    }
    if (!(all > 0)) return {};
    std::size_t p = 0;
    float rest = choice * all;
    for (std::size_t i = 0; i < LightNode::kPoints && rest >= 0; rest -= facing[i++])
        if (facing[i] > 0) p = i;
    const float alpha = std::max(light.material(node.surface).ggx_alpha, KeptLight::min_alpha(light.table()));
    const KeptLight::Lobe lobe = light.lobe(member.out, member.links, {}, static_cast<std::uint32_t>(n),
                                            unpack_normal(node.normal[p]), to, alpha);
    return light.facet_color(n, light.albedo(node.surface).lobe(facing[p])) * lobe.kept;
}

}  // namespace hilcam
