#include "render/paths/mirror_rays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "render/brdf/microfacet.h"
#include "render/shading/lamp_light.h"
#include "render/shading/sample_offsets.h"
#include "render/visibility/place_sequence.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

// The places of a pixel's rays in the disk of visible facets, by number.
struct Places {
    alignas(64) std::array<float, kMaxVisibilitySamples> radius, cosine, sine;
};
const Places kMirrorPlaces = [] {
    Places out;
    for (std::size_t i = 0; i < kMaxVisibilitySamples; ++i) {
        const float number = static_cast<float>(i) + 0.5f;
        const DiskPlace at =
            DiskPlace::of(std::fmod(kPlasticAlong * number, 1.0f), std::fmod(kPlasticAbout * number, 1.0f));
        out.radius[i] = at.radius, out.cosine[i] = at.cosine, out.sine[i] = at.sine;
    }
    return out;
}();

// Three coordinates for each lane.
struct Lanes {
    using Floats = std::array<float, kPacketSize>;
    alignas(64) Floats x{}, y{}, z{};
    Vec3f at(std::size_t k) const { return {x[k], y[k], z[k]}; }
    void set(std::size_t k, Vec3f v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
};

// Reflects the views of a shading point's samples by one facet each, from place `first` on. to_viewer_m: from
// the shading point; ways_m: from it to the samples.
HILCAM_CLONES void reflect_views(float alpha, const Frame& lobe, Vec3f to_viewer_m, const Lanes& ways_m,
                                 std::size_t first, Lanes& dirs) {
    const Frame local = lobe;
    const float *radius = kMirrorPlaces.radius.data() + first, *cosine = kMirrorPlaces.cosine.data() + first,
                *sine = kMirrorPlaces.sine.data() + first;
    for (std::size_t k = 0; k < kPacketSize; ++k)
        dirs.set(k, sample_facets(alpha, local, normalized(to_viewer_m - ways_m.at(k)),
                                  {radius[k], cosine[k], sine[k]}));
}

// Sends some of the rays, each from another remaining sample and by a facet of its own. first: number of rays
// before, a multiple of kPacketSize.
void send(Tile& tile, const ShadingPoint& at, SampleMask& left, std::size_t first, std::size_t count,
          MirrorRays::Packet& out) {
    const FrameContext& frame = tile.frame;
    const float distance_m = at.footprint_m * static_cast<float>(frame.geometry.focal_length_px);
    const SampleOffsets way(tile, at);
    Lanes ways_m, dirs;
    for (std::size_t k = 0; k < count; ++k)
        ways_m.set(k, way.to(next_sample(frame.samples, left, at.samples)));
    reflect_views(at.surface.alpha, Frame(at.normal), distance_m * at.view_dir, ways_m, first, dirs);
    out.rays.count = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (dot(at.geometric_normal, dirs.at(k)) > 0)
            out.rays.set(out.rays.count++, at.start() + ways_m.at(k), dirs.at(k), 0,
                         std::numeric_limits<float>::infinity());
    frame.scene->intersect(out.rays, Coherence::kCoherent, out.hits);
    prefetch_shading_points(frame, out.hits, out.rays.count);
    tile.stats.secondary_rays += static_cast<std::uint64_t>(out.rays.count);
    out.met = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(out.rays.count); ++k)
        if (meets_object(frame, out.hits, k, out.rays.origin(k), out.rays.dir(k))) out.met |= 1u << k;
}

// True when everything that these rays meet is dark and faces away from the Sun: compared with the sensor's
// noise it then matters little how much of a pixel shows it. Sunlight that the mirror reflects onto such a
// thing is not considered.
bool meet_the_dark(const FrameContext& frame, const MirrorRays::Packet& packet) {
    // Reflectance. An edge that sixteen rays see is off by a thirtieth of a pixel. For a thing that receives
    // a tenth of the light of white paint and reflects a tenth of it, that is 1/3000 of the paint's light.
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
        if (sunlit || max_component(material.base) + max_component(material.highlight) > kDark ||
            !material.emission.none())
            return false;
    }
    return true;
}

}  // namespace

bool meets_object(const FrameContext& frame, const HitPacket& hits, std::size_t lane, Vec3f origin_m,
                  Vec3f dir) {
    return hits.object[lane] != HitPacket::kMiss &&
           !(frame.bodies_may_hide &&
             frame.background->hides(origin_m, to_double(dir), static_cast<double>(hits.distance[lane])));
}

std::size_t MirrorRays::trace(Tile& tile, const ShadingPoint& at, std::size_t most) {
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
