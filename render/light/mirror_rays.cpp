#include "render/light/mirror_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/brdf/microfacet.h"
#include "render/light/lamp_light.h"
#include "render/light/primary_vertices.h"
#include "render/visibility/place_sequence.h"

namespace hilcam {
namespace {

// Sends some of the rays, each from another of the samples that are left and by a facet of its own. first: how many there were
// before.
void send(Tile& tile, const Vertex& at, SampleMask& left, std::size_t first, std::size_t count,
          MirrorRays::Packet& out) {
    const FrameView& frame = tile.frame;
    const float distance_m = at.footprint_m * static_cast<float>(frame.geometry.focal_length_px);
    const Frame local(at.normal);
    out.rays.count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f way_m = way_to_sample(tile, at, next_sample(frame.samples, left, at.samples));
        const float number = static_cast<float>(first + i) + 0.5f;
        const Vec3f dir =
            sample_facets(at.surface.alpha, local, normalized(distance_m * at.view_dir - way_m),
                          std::fmod(kPlasticAlong * number, 1.0f), std::fmod(kPlasticAbout * number, 1.0f));
        if (dot(at.geometric_normal, dir) > 0)
            out.rays.set(out.rays.count++, at.start() + way_m, dir, 0,
                         std::numeric_limits<float>::infinity());
    }
    frame.scene->intersect(out.rays, Coherence::kCoherent, out.hits);
    tile.stats.secondary_rays += static_cast<std::uint64_t>(out.rays.count);
    out.met = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(out.rays.count); ++k)
        if (meets_object(frame, out.hits, k, out.rays.origin(k), out.rays.dir(k))) out.met |= 1u << k;
}

// True when all that these meet is dark and faces away from the Sun: against the sensor's noise it matters little how much of a
// pixel shows it. What a mirror throws of the Sun on such a thing is not asked for.
bool meet_the_dark(const FrameView& frame, const MirrorRays::Packet& packet) {
    // Reflectance. An edge that sixteen rays see is off by a thirtieth of a pixel; of what has a tenth of the light of white paint
    // for its own, and reflects a tenth of it, that is a third of a thousandth of the paint's light.
    constexpr float kDark = 0.1f;
    if (packet.met != 0 && frame.lamps && !frame.lamps->lit().empty()) return false;
    const Vec3f sun = to_float(frame.background->sun_world_dir());
    const HitPacket& hits = packet.hits;
    for (std::uint32_t rest = packet.met; rest != 0; rest &= rest - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(rest));
        const ObjectSurfaces& object = *(*frame.objects)[hits.object[k]];
        const Material& material = object.materials[object.triangles[hits.triangle[k]].surface];
        const Vec3f normal = frame.world_from_body[hits.object[k]] *
                             Vec3f{hits.normal_x[k], hits.normal_y[k], hits.normal_z[k]};
        const bool sunlit = dot(normal, sun) * dot(normal, packet.rays.dir(k)) < 0;
        if (sunlit || largest(material.base) + largest(material.highlight) > kDark ||
            largest(material.emission) > 0)
            return false;
    }
    return true;
}

}  // namespace

bool meets_object(const FrameView& frame, const HitPacket& hits, std::size_t lane, Vec3f origin_m,
                  Vec3f dir) {
    return hits.object[lane] != HitPacket::kMiss &&
           !(frame.bodies_may_hide &&
             frame.background->hides(origin_m, to_double(dir), static_cast<double>(hits.distance[lane])));
}

std::size_t MirrorRays::trace(Tile& tile, const Vertex& at, std::size_t most) {
    SampleMask left = at.samples;
    const std::size_t all = std::min(static_cast<std::size_t>(std::popcount(left)), most);
    std::size_t sent = 0;
    for (count_ = 0; sent < all && !(count_ == 1 && meet_the_dark(tile.frame, packets_[0])); ++count_) {
        const std::size_t count = std::min<std::size_t>(kPacketSize, all - sent);
        send(tile, at, left, sent, count, packets_[count_]);
        sent += count;
    }
    return sent;
}

}  // namespace hilcam
