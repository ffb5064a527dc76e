#include "render/radiosity/inter_object_links.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

constexpr float kMeetsNothing = std::numeric_limits<float>::infinity();
constexpr std::size_t kProbesAtOnce = 256;  // probes

struct Probe {
    std::size_t probe;  // number of the probe in the block
    std::uint16_t direction;
    Vec3f origin_m, dir;
    float distance_m = kMeetsNothing;
    InterObjectLinks::Link link{};
};

// Traces the free directions of a block of probes against their neighbours.
class Prober {
  public:
    Prober(std::span<const NeighbourObject> near, const IrradianceCache& self,
           std::span<const IrradianceCache* const> lights, const EmbreeScene& scene)
        : near_(near), self_(self), lights_(lights), scene_(scene) {}

    // Finds the directions that meet a surface, with its probe; kDark if it caches no light.
    static constexpr std::uint32_t kDark = ~std::uint32_t{0};
    std::vector<Probe> probe(std::size_t first, std::size_t last) const {
        std::vector<Probe> probes;
        for (std::size_t n = first; n < last; ++n) aim(n, n - first, probes);
        for (const NeighbourObject& other : near_) ask(other, probes);
        std::erase_if(probes, [](const Probe& p) { return p.distance_m == kMeetsNothing; });
        return probes;
    }

  private:
    std::span<const NeighbourObject> near_;
    const IrradianceCache& self_;
    std::span<const IrradianceCache* const> lights_;
    const EmbreeScene& scene_;

    bool may_meet(const NeighbourObject& other, Vec3f origin_m, Vec3f dir) const {
        return lights_[other.object]->bounds().is_met(other.place(origin_m), other.dir(dir));
    }

    void aim(std::size_t n, std::size_t in_block, std::vector<Probe>& probes) const {
        const TransferTable& table = self_.table();
        for (std::size_t d = 0; d < static_cast<std::size_t>(table.directions()); ++d) {
            if (!table.is_free(n, d)) continue;
            const Vec3f origin = table.probes().probes()[n].point_m[table.point_of(d)];
            const Vec3f dir = self_.direction(n, d);
            if (std::any_of(near_.begin(), near_.end(),
                            [&](const NeighbourObject& other) { return may_meet(other, origin, dir); }))
                probes.push_back({in_block, static_cast<std::uint16_t>(d), origin, dir});
        }
    }

    void ask(const NeighbourObject& other, std::vector<Probe>& probes) const {
        std::vector<Probe*> asked;
        for (Probe& probe : probes)
            if (may_meet(other, probe.origin_m, probe.dir)) asked.push_back(&probe);
        RayPacket rays;
        HitPacket hits;
        std::array<float, kPacketSize> from;
        for (std::size_t first = 0; first < asked.size(); first += kPacketSize) {
            const std::span<Probe*> packet(asked.data() + first,
                                           std::min<std::size_t>(kPacketSize, asked.size() - first));
            rays.count = static_cast<int>(packet.size());
            from.fill(0);
            constexpr int kMaxSheets = 16;
            for (int sheet = 0; sheet < kMaxSheets; ++sheet) {
                for (std::size_t i = 0; i < packet.size(); ++i)
                    rays.set(static_cast<int>(i), other.place(packet[i]->origin_m), other.dir(packet[i]->dir),
                             from[i], packet[i]->distance_m);
                scene_.intersect_with(other.object, rays, hits);
                bool again = false;
                for (std::size_t i = 0; i < packet.size(); ++i) {
                    if (hits.object[i] == HitPacket::kMiss) continue;
                    if (!note(other, hits, i, *packet[i])) {
                        // Continues behind a sheet of glass.
                        from[i] = hits.distance[i] * (1 + 1e-5f) + 1e-5f;
                        again = true;
                    }
                }
                if (!again) break;
            }
        }
    }

    bool note(const NeighbourObject& other, const HitPacket& hits, std::size_t k, Probe& probe) const {
        const IrradianceCache& light = *lights_[other.object];
        const std::uint16_t surface = light.surface_of(hits.triangle[k]);
        if (light.is_glass(surface)) return false;
        const Vec3f dir = other.dir(probe.dir);
        const Vec3f normal{hits.normal_x[k], hits.normal_y[k], hits.normal_z[k]};
        const bool back = dot(normal, dir) > 0;
        ProbeWeights about;
        probe.distance_m = hits.distance[k];
        const bool found = light.table().probes().find(other.place(probe.origin_m) + hits.distance[k] * dir,
                                                       {back ? -normal : normal, surface, back}, about);
        // Light from mirrors is too sharp to be cached from object to object.
        const bool keeps = found && about.count > 0 && !light.is_mirror(surface);
        probe.link = {keeps ? about.nearest() : kDark, static_cast<std::uint16_t>(other.object),
                      probe.direction};
        return true;
    }
};

}  // namespace

NeighbourObject NeighbourObject::rounded(const Pose& self, const Pose& other, std::size_t object,
                                         float step_rad, float min_m) {
    const Quat turn = conjugate(other.world_from_body) * self.world_from_body;
    // A component of the quaternion: the sine of half the angle.
    const double step = 0.5 * static_cast<double>(step_rad);
    const auto part = [step](double x) { return step * std::round(x / step); };
    const Mat3d axes = to_matrix(normalized(Quat{part(turn.w), part(turn.x), part(turn.y), part(turn.z)}));
    const Vec3d shift =
        to_matrix(conjugate(other.world_from_body)) * (self.position_world_m - other.position_world_m);
    const double grid =
        std::max(static_cast<double>(min_m), std::exp2(std::floor(std::log2(length(shift) + 1e-9)) - 6));
    const auto place = [grid](double x) { return static_cast<float>(grid * std::round(x / grid)); };
    return {object,
            {to_float(axes.x), to_float(axes.y), to_float(axes.z)},
            {place(shift.x), place(shift.y), place(shift.z)}};
}

const NeighbourObject& InterObjectLinks::neighbour(std::size_t object) const {
    return *std::find_if(near_.begin(), near_.end(),
                         [object](const NeighbourObject& n) { return n.object == object; });
}

void InterObjectLinks::make(std::span<const NeighbourObject> near, std::size_t self,
                            std::span<const IrradianceCache* const> lights, const EmbreeScene& scene) {
    near_.assign(near.begin(), near.end());
    links_.clear(), first_.clear(), free_.clear();
    const IrradianceCache& light = *lights[self];
    const TransferTable& table = light.table();
    if (near.empty() || table.size() == 0) return;
    const Prober prober(near_, light, lights, scene);
    std::vector<std::vector<Probe>> blocks((table.size() + kProbesAtOnce - 1) / kProbesAtOnce);
    const auto ask = [&](std::size_t b) {
        blocks[b] = prober.probe(b * kProbesAtOnce, std::min(table.size(), (b + 1) * kProbesAtOnce));
        std::stable_sort(blocks[b].begin(), blocks[b].end(),
                         [](const Probe& x, const Probe& y) { return x.probe < y.probe; });
    };
    // One block at a time, so that waiting for one is short.
    tbb::parallel_for(std::size_t{0}, blocks.size(), ask, tbb::simple_partitioner{});
    const std::size_t words = table.free(0).size();
    for (std::size_t n = 0; n < table.size(); ++n)
        free_.insert(free_.end(), table.free(n).begin(), table.free(n).end());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        std::size_t next = 0;
        for (std::size_t n = b * kProbesAtOnce; n < std::min(table.size(), (b + 1) * kProbesAtOnce); ++n) {
            first_.push_back(static_cast<std::uint32_t>(links_.size()));
            for (; next < blocks[b].size() && blocks[b][next].probe == n - b * kProbesAtOnce; ++next) {
                const Probe& probe = blocks[b][next];
                free_[n * words + probe.direction / 64] &= ~(std::uint64_t{1} << (probe.direction % 64));
                if (probe.link.probe != Prober::kDark) links_.push_back(probe.link);
            }
        }
    }
    first_.push_back(static_cast<std::uint32_t>(links_.size()));
}

std::size_t InterObjectLinks::bytes() const {
    return first_.size() * sizeof(std::uint32_t) + links_.size() * sizeof(Link) +
           free_.size() * sizeof(std::uint64_t);
}

}  // namespace hilcam
