#include "render/shading/normal_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "render/shading/cluster_packet.h"
#include "render/vocabulary/lane_sum.h"

namespace hilcam {
namespace {

constexpr float kSame = 0.999998f;  // cosine
// The single LOD normal of a cluster that has flattened none.
const LodNormals kItself = LodNormals::flat();

// Sorts the clusters of shading points into packets of one material of an object each.
class Reflection {
  public:
    Reflection(const FrameContext& frame, std::span<const SunlitPoint> points, std::span<ClusterLight> out)
        : frame_(frame), points_(points), out_(out) {}

    void of_all() {
        std::array<std::uint16_t, SunlitPoint::kMaxTogether> order;
        const std::span<std::uint16_t> in_order = std::span(order).first(points_.size());
        std::iota(in_order.begin(), in_order.end(), std::uint16_t{0});
        const auto key = [&](std::uint16_t v) {
            const ShadingPoint& at = *points_[v].at;
            return std::uint64_t{at.object} << 32 | std::uint64_t{at.surface_number} << 16 | v;
        };
        std::sort(in_order.begin(), in_order.end(),
                  [&](std::uint16_t a, std::uint16_t b) { return key(a) < key(b); });
        for (const std::uint16_t v : in_order) put(v);
        reflect();
        for (const std::uint16_t v : in_order) finish(v);
    }

  private:
    const FrameContext& frame_;
    std::span<const SunlitPoint> points_;
    std::span<ClusterLight> out_;
    ClusterPacket packet_;
    std::array<const NormalCluster*, ClusterPacket::kSize> clusters_;
    std::array<std::uint16_t, ClusterPacket::kSize> owners_;  // shading points
    const ShadingPoint* kind_ = nullptr;                      // one of those in the packet
    struct Sum {
        float samples;
        // The reflection by a cluster's lobe. It depends only on the angle between viewer and light.
        Spectrum mirrored;
        float light;              // over all bins together
        float going_on;           // light so far of clusters that belong to one curved triangle
        SubpixelMoments moments;  // times the light
    };
    std::array<Sum, SunlitPoint::kMaxTogether> sums_;

    void put(std::uint16_t v) {
        const auto& [at, dir, alpha] = points_[v];
        if (kind_ && (kind_->object != at->object || kind_->surface.material != at->surface.material))
            reflect();
        kind_ = at;
        sums_[v] = {};
        const float io = dot(at->view_dir, dir), over_half = 1 / std::sqrt(std::max(2 + 2 * io, 1e-8f));
        if (alpha > 0) sums_[v].mirrored = brdf_mirrored(at->surface, half_vector({1, 1, io}).ih);
        const float side = at->back ? -1.0f : 1.0f;
        for (const NormalCluster* cluster = at->clusters; cluster; cluster = cluster->next) {
            sums_[v].samples += cluster->samples;
            const float flat = dot(cluster->geometric_normal, dir);
            if (!cluster->flattened && flat <= 0) continue;
            if (packet_.count == ClusterPacket::kSize) reflect();
            const std::size_t i = packet_.count++;
            clusters_[i] = cluster, owners_[i] = v;
            packet_.normal.set(i, cluster->normal);
            packet_.view.set(i, at->view_dir), packet_.light.set(i, dir);
            packet_.samples[i] = cluster->samples;
            packet_.flat[i] = cluster->flattened ? flat : 0.0f;
            packet_.side[i] = side;
            packet_.over_half[i] = over_half, packet_.alpha_squared[i] = alpha * alpha;
            packet_.parts[i] = cluster->flattened ? *cluster->flattened : kItself;
        }
    }

    void reflect() {
        if (packet_.count == 0) return;
        const Bsdf& surface = kind_->surface;
        const LobeAlbedo* const facets = facets_of(*surface.material);
        reflect_clusters(frame_.world_from_body[kind_->object], facets, packet_);
        const bool diffuse = std::holds_alternative<brdf::Lambert>(surface.material->brdf);
        for (std::size_t i = 0; i < packet_.count; ++i) {
            const std::uint16_t v = owners_[i];
            const Spectrum& base = points_[v].at->surface.base;
            const float lobe = points_[v].alpha > 0 ? packet_.lobe[i] : 0.0f;
            if (facets)
                take(v, *clusters_[i], packet_.below[i] * base + lobe * sums_[v].mirrored);
            else
                take(v, *clusters_[i], diffuse ? packet_.lit[i] / kPiF * base : part_by_part(i));
        }
        packet_.count = 0;
    }

    void take(std::uint16_t v, const NormalCluster& cluster, const Spectrum& reflected) {
        const float light = lane_sum(reflected.bin);
        const SubpixelMoments moments =
            cluster.seen_by != 0 ? frame_.samples.moments(cluster.seen_by) : points_[v].at->moments;
        out_[v].reflected += reflected;
        Sum& sum = sums_[v];
        sum.light += light, sum.going_on += light;
        sum.moments += light * moments;
        // Shadow rays treat these as one.
        if (!cluster.goes_on) out_[v].add(cluster, std::exchange(sum.going_on, 0.0f));
    }

    Spectrum part_by_part(std::size_t i) const {
        const SunlitPoint& from = points_[owners_[i]];
        const float io = dot(from.at->view_dir, from.dir);
        Spectrum sum;
        for (std::size_t j = 0; j < ClusterPacket::kParts; ++j)
            if (const float weight = packet_.weight[j][i]; weight > 0)
                sum += weight * brdf_value(from.at->surface, {packet_.no[j][i], packet_.ni[j][i], io});
        return sum;
    }

    void finish(std::uint16_t v) {
        const ShadingPoint& at = *points_[v].at;
        const Sum& sum = sums_[v];
        out_[v].reflected = (1 / sum.samples) * (at.throughput * out_[v].reflected);
        out_[v].moments = sum.light > 0 ? (1 / sum.light) * sum.moments : at.moments;
    }
};

}  // namespace

void ClusterLight::add(const NormalCluster& cluster, float light) {
    if (!(light > share.back())) return;
    std::size_t place = share.size() - 1;
    for (; place > 0 && light > share[place - 1]; --place)
        share[place] = share[place - 1], brightest[place] = brightest[place - 1];
    share[place] = light, brightest[place] = &cluster;
}

// Member by member: a NormalCluster that is copied whole waits for its own stores.
void NormalClusters::push(const NormalCluster& part, ShadingPoint& point) {
    NormalCluster& added = clusters_[count_++];
    added.geometric_normal = part.geometric_normal;
    added.normal = part.normal;
    added.start_m = part.start_m;
    added.samples = part.samples;
    added.seen_by = part.seen_by;
    added.flattened = part.flattened;
    added.goes_on = part.goes_on;
    added.next = point.clusters;
    point.clusters = &added;
}

void NormalClusters::add(const FrameContext& frame, NormalCluster part, std::uint32_t triangle, bool first,
                         std::span<const Vec3f> turns, ShadingPoint& point) {
    const ObjectSurfaces& object = *(*frame.objects)[point.object];
    bool has_flattened = false;
    if (!object.lod_normals.empty()) {
        has_flattened = object.flattened_alpha[point.surface_number] > 0;
        if (!object.lod_normals[triangle].is_flat()) part.flattened = &object.lod_normals[triangle];
        if (first) point.cluster_alpha = object.unflattened(point.surface_number, point.surface.alpha);
    }
    const bool alike = turns.empty() && (first || dot(point.normal, part.normal) > kSame);
    if (alike && !part.flattened && !has_flattened && !point.clusters) return;
    if (!first && !point.clusters)
        push({point.geometric_normal, point.normal, point.start(), point.weight_samples, point.samples},
             point);
    if (turns.empty()) return push(part, point);
    part.samples /= static_cast<float>(turns.size());
    for (const Vec3f normal : turns) {
        part.normal = normal;
        push(part, point);
        part.goes_on = true;
    }
}

void lit_clusters(const FrameContext& frame, std::span<const SunlitPoint> points,
                  std::span<ClusterLight> out) {
    if (!points.empty()) Reflection(frame, points, out).of_all();
}

}  // namespace hilcam
