#include "render/probes/transfer_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "render/brdf/microfacet.h"
#include "render/probes/probe_axes.h"
#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

constexpr float kGoldenRatio = 0.61803399f;
// The rotation from probe to probe, in turns: the root of a half. The number of directions of two to nine
// neighbouring probes in a small disk then varies a third as much as with the golden section, which would map
// the golden-angle spiral onto its own next directions (docs/decisions.md#cached-light-in-probes).
constexpr float kTurn = 0.70710678f;
constexpr float kFarthest = std::numeric_limits<float>::infinity();

// The state of a direction during tracing: the probe that it meets, whether that is nearer than half a cube,
// and which of its points is nearest to the hit; or one of these values.
struct Met {
    static std::uint32_t pack(std::uint32_t probe, bool close, std::size_t point) {
        return probe << 3 | static_cast<std::uint32_t>(close) << 2 | static_cast<std::uint32_t>(point);
    }
    static std::uint32_t probe(std::uint32_t met) { return met >> 3; }
    static bool is_close(std::uint32_t met) { return met >> 2 & 1u; }
    static std::uint32_t point(std::uint32_t met) { return met & 3u; }
};
static_assert(SurfaceProbe::kPoints == 4);
constexpr std::uint32_t kFree = ~std::uint32_t{0};
constexpr std::uint32_t kDarkNode = kFree - 1;
constexpr std::uint32_t kBuried = kFree - 2;  // point that does not count
constexpr std::uint32_t kUnder = kFree - 3;   // below the surface at its point; does not count
constexpr std::uint32_t kTracing = kFree - 4;

struct Ray {
    std::size_t direction;
    Vec3f origin_m, dir;
    int sheets = 0;  // sheets of glass passed so far
};

// Traces a block of probes.
class Tracer {
  public:
    Tracer(const Mesh& mesh, std::span<const std::uint8_t> glass, const SurfaceProbes& probes,
           const EmbreeScene& scene, std::span<const Vec3f> local, std::span<const Vec2f> turns)
        : mesh_(mesh), glass_(glass), probes_(probes), scene_(scene), local_(local), turns_(turns) {}

    // met: by probe and direction of the block.
    void trace(std::size_t first, std::size_t last, std::span<std::uint32_t> met) const {
        std::vector<Ray> rays;
        for (std::size_t n = first; n < last; ++n) {
            const std::span<std::uint32_t> of_probe = met.subspan((n - first) * local_.size(), local_.size());
            std::vector<float> distance(local_.size(), kFarthest);
            aim(n, of_probe, rays);
            follow(rays, of_probe, distance);
            drop_buried(of_probe, distance);
        }
    }

  private:
    const Mesh& mesh_;
    std::span<const std::uint8_t> glass_;
    const SurfaceProbes& probes_;
    const EmbreeScene& scene_;
    std::span<const Vec3f> local_;
    std::span<const Vec2f> turns_;

    void aim(std::size_t n, std::span<std::uint32_t> met, std::vector<Ray>& rays) const {
        const SurfaceProbe& probe = probes_.probes()[n];
        rays.clear();
        const Frame frame(unpack_normal(probe.mean_normal));
        const std::size_t of_point = local_.size() / SurfaceProbe::kPoints;
        for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p) {
            const Vec3f geometric = unpack_normal(probe.geometric[p]);
            for (std::size_t d = p * of_point; d < (p + 1) * of_point; ++d) {
                const Vec3f dir = probe_direction(frame, turns_[n], local_[d]);
                met[d] = kUnder;
                if (dot(dir, geometric) <= 0) continue;
                met[d] = kTracing;
                rays.push_back({d, probe.point_m[p], dir});
            }
        }
    }

    void follow(std::vector<Ray>& rays, std::span<std::uint32_t> met, std::span<float> distance) const {
        RayPacket packet;
        HitPacket hits;
        std::vector<Ray> through;  // glass
        while (!rays.empty()) {
            through.clear();
            for (std::size_t first = 0; first < rays.size(); first += kPacketSize) {
                packet.count = static_cast<int>(std::min<std::size_t>(kPacketSize, rays.size() - first));
                for (int i = 0; i < packet.count; ++i) {
                    const Ray& ray = rays[first + static_cast<std::size_t>(i)];
                    packet.set(i, ray.origin_m, ray.dir, 0, kFarthest);
                }
                scene_.intersect(packet, Coherence::kIncoherent, hits);
                for (int i = 0; i < packet.count; ++i)
                    meet(rays[first + static_cast<std::size_t>(i)], hits, static_cast<std::size_t>(i), met,
                         distance, through);
            }
            rays.swap(through);
        }
    }

    void meet(const Ray& ray, const HitPacket& hits, std::size_t k, std::span<std::uint32_t> met,
              std::span<float> distance, std::vector<Ray>& through) const {
        std::uint32_t& out = met[ray.direction];
        if (hits.object[k] == HitPacket::kMiss) {
            out = kFree;
            return;
        }
        const Vec3f point_m = ray.origin_m + hits.distance[k] * ray.dir;
        const std::uint16_t surface = mesh_.surface_of_triangle[hits.triangle[k]];
        if (glass_[surface]) {
            // The same offset as for rays in shading_point.cpp.
            const float greatest = std::max({std::abs(point_m.x), std::abs(point_m.y), std::abs(point_m.z)});
            constexpr int kMaxSheets = 16;
            out = kDarkNode;
            if (ray.sheets < kMaxSheets)
                through.push_back({ray.direction,
                                   point_m + 32 * std::numeric_limits<float>::epsilon() * greatest * ray.dir,
                                   ray.dir, ray.sheets + 1});
            return;
        }
        if (ray.sheets == 0) distance[ray.direction] = hits.distance[k];
        const Vec3f normal{hits.normal_x[k], hits.normal_y[k], hits.normal_z[k]};
        const bool back = dot(normal, ray.dir) > 0;
        ProbeWeights about;
        out = kDarkNode;
        if (probes_.find(point_m, {back ? -normal : normal, surface, back}, about) && about.count > 0) {
            const std::uint32_t probe = about.nearest();
            out = Met::pack(probe, hits.distance[k] < 0.5f * probes_.cube_m(),
                            next_point(probes_.probes()[probe], point_m));
        }
    }

    static std::size_t next_point(const SurfaceProbe& probe, Vec3f place_m) {
        std::size_t best = 0;
        float least = kFarthest;
        for (std::size_t p = 0; p < SurfaceProbe::kPoints; ++p) {
            const Vec3f way = probe.point_m[p] - place_m;
            if (dot(way, way) < least) least = dot(way, way), best = p;
        }
        return best;
    }

    void drop_buried(std::span<std::uint32_t> met, std::span<const float> distance) const {
        const std::size_t of_point = met.size() / SurfaceProbe::kPoints;
        for (std::size_t first = 0; first < met.size(); first += of_point) {
            bool buried = true;
            for (std::size_t d = first; d < first + of_point; ++d)
                buried = buried && met[d] != kFree &&
                         (met[d] == kDarkNode || distance[d] < 0.5f * probes_.cube_m());
            if (buried) std::fill_n(met.begin() + static_cast<std::ptrdiff_t>(first), of_point, kBuried);
        }
    }
};

// Returns the openness from sixteen directions; glass is transparent.
OpenShares openness(const Mesh& mesh, std::span<const std::uint8_t> glass, const EmbreeScene& scene,
                    Vec3f point_m, Vec3f normal, float near_m, float far_m) {
    static const std::vector<Vec3f> kDirections = transfer_directions(kPacketSize);
    const Frame frame(normal);
    RayPacket rays;
    HitPacket hits;
    rays.count = kPacketSize;
    for (std::size_t i = 0; i < kPacketSize; ++i)
        rays.set(static_cast<int>(i), point_m, frame.to_world(kDirections[i]), 0, far_m);
    scene.intersect(rays, Coherence::kIncoherent, hits);
    int near = 0, far = 0;
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        const bool open =
            hits.object[i] == HitPacket::kMiss || glass[mesh.surface_of_triangle[hits.triangle[i]]];
        far += open, near += open || hits.distance[i] > near_m;
    }
    return {static_cast<float>(near) / kPacketSize, static_cast<float>(far) / kPacketSize};
}

// Glass is not a wall.
std::optional<Wall> wall_between(std::span<const std::uint8_t> glass, const Mesh& mesh,
                                 const EmbreeScene& scene, Vec3f from_m, Vec3f to_m) {
    const Vec3f way_m = to_m - from_m;
    const float distance_m = length(way_m);
    if (!(distance_m > 0)) return std::nullopt;
    RayPacket ray;
    HitPacket hit;
    ray.count = 1;
    ray.set(0, from_m, way_m / distance_m, 0, distance_m);
    scene.intersect(ray, Coherence::kIncoherent, hit);
    if (hit.object[0] == HitPacket::kMiss || glass[mesh.surface_of_triangle[hit.triangle[0]]])
        return std::nullopt;
    return Wall{from_m + hit.distance[0] / distance_m * way_m,
                {hit.normal_x[0], hit.normal_y[0], hit.normal_z[0]}};
}

}  // namespace

std::vector<Vec3f> transfer_directions(int count) {
    std::vector<Vec3f> out;
    for (int point = 0; point < SurfaceProbe::kPoints; ++point)
        for (int i = point; i < count; i += SurfaceProbe::kPoints) {
            const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
            const float r = std::sqrt(u), phi = 2 * kPiF * kGoldenRatio * static_cast<float>(i);
            out.push_back({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)});
        }
    return out;
}

TransferTable::TransferTable(const Mesh& mesh, std::span<const std::uint8_t> glass,
                             const TransferSettings& settings, const WorkWatcher& watcher)
    : directions_(settings.directions) {
    if (watcher) watcher(0);
    std::vector<std::uint8_t> keeps;
    for (const std::uint8_t is_glass : glass) keeps.push_back(!is_glass);
    EmbreeScene scene(std::vector<std::vector<const Mesh*>>{{&mesh}}, false);
    scene.place(std::vector<Pose>(1), std::vector<std::size_t>(1), {});
    probes_ = SurfaceProbes(
        mesh, keeps, std::min(settings.probes, kMaxProbes / 2),
        [&](Vec3f point_m, Vec3f normal, float near_m, float far_m) {
            if (watcher) watcher(0);
            return openness(mesh, glass, scene, point_m, normal, near_m, far_m);
        },
        [&](Vec3f from_m, Vec3f to_m) { return wall_between(glass, mesh, scene, from_m, to_m); });
    for (std::size_t n = 0; n < size(); ++n) {
        // Rotations that differ strongly from those of neighbouring probes.
        const float part = std::fmod(static_cast<float>(n % 4096) * kTurn, 1.0f);
        turns_.push_back({std::cos(2 * kPiF * part), std::sin(2 * kPiF * part)});
    }
    std::vector<Block> blocks = trace(mesh, glass, scene, watcher);
    drop_dead_ends(blocks);
    pack(blocks, numbers_of_open(blocks, settings.enclosed));
}

std::vector<TransferTable::Block> TransferTable::trace(const Mesh& mesh, std::span<const std::uint8_t> glass,
                                                       const EmbreeScene& scene, const WorkWatcher& watcher) {
    const std::vector<Vec3f> local = transfer_directions(directions_);
    std::vector<Block> blocks((size() + kBlock - 1) / kBlock);
    free_.assign(size() * free_words(), 0);
    live_.assign(size(), 0), counted_.assign(size(), 0);
    if (blocks.empty()) return blocks;
    const Tracer tracer(mesh, glass, probes_, scene, local, turns_);
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
        if (watcher) watcher(static_cast<double>(done.fetch_add(1)) / static_cast<double>(blocks.size()));
        const std::size_t first = b * kBlock, last = std::min(size(), first + kBlock);
        std::vector<std::uint32_t> met((last - first) * local.size());
        tracer.trace(first, last, met);
        for (std::size_t n = first; n < last; ++n) {
            const std::size_t before = blocks[b].links.size();
            for (std::size_t d = 0; d < local.size(); ++d) {
                const std::uint32_t m = met[(n - first) * local.size() + d];
                if (m == kBuried) continue;
                live_[n] = static_cast<std::uint8_t>(live_[n] | 1u << point_of(d));
                if (m == kUnder) continue;
                ++counted_[n];
                if (m == kFree) free_[n * free_words() + d / 64] |= std::uint64_t{1} << (d % 64);
                if (m != kFree && m != kDarkNode)
                    blocks[b].links.push_back({m, static_cast<std::uint8_t>(d)});
            }
            blocks[b].counts.push_back(blocks[b].links.size() - before);
        }
    });
    return blocks;
}

// Calls visit(probe, its links).
void TransferTable::for_each_probe(std::vector<Block>& blocks,
                                   const std::function<void(std::size_t, std::span<Link>)>& visit) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        std::size_t first = 0;
        for (std::size_t i = 0; i < blocks[b].counts.size(); ++i) {
            visit(b * kBlock + i, std::span(blocks[b].links).subspan(first, blocks[b].counts[i]));
            first += blocks[b].counts[i];
        }
    }
}

// Links that meet a buried point closely become dark: such a direction is buried, too, and the probe uses
// those of its other points.
void TransferTable::drop_dead_ends(std::vector<Block>& blocks) {
    for_each_probe(blocks, [&](std::size_t, std::span<Link> links) {
        for (Link& link : links)
            if (Met::is_close(link.met) && !is_live(Met::probe(link.met), Met::point(link.met)))
                link.met = kDarkNode;
    });
}

// Returns new numbers for the probes that light reaches: those that are free somewhere, or meet one that
// light reaches.
std::vector<std::uint32_t> TransferTable::numbers_of_open(std::vector<Block>& blocks, bool enclosed) {
    std::vector<std::uint8_t> open(size(), enclosed);
    for (std::size_t n = 0; n < size(); ++n)
        for (std::size_t w = 0; w < free_words(); ++w) open[n] |= free_[n * free_words() + w] != 0;
    for (bool more = true; more;) {
        more = false;
        for_each_probe(blocks, [&](std::size_t n, std::span<Link> links) {
            const auto leads_out = [&](const Link& l) {
                return l.met != kDarkNode && open[Met::probe(l.met)] != 0;
            };
            if (!open[n] && std::any_of(links.begin(), links.end(), leads_out)) open[n] = 1, more = true;
        });
    }
    std::vector<std::uint32_t> numbers(size(), SurfaceProbes::kClosed);
    std::uint32_t kept = 0;
    for (std::size_t n = 0; n < size(); ++n)
        if (open[n] && counted_[n] != 0) numbers[n] = kept++;
    return numbers;
}

void TransferTable::pack(std::vector<Block>& blocks, std::span<const std::uint32_t> numbers) {
    first_entry_.push_back(0);
    for_each_probe(blocks, [&](std::size_t n, std::span<Link> links) {
        const std::size_t to = numbers[n];
        if (to == SurfaceProbes::kClosed) return;
        for (const Link& link : links) {
            const std::uint32_t probe =
                link.met == kDarkNode ? SurfaceProbes::kClosed : numbers[Met::probe(link.met)];
            if (probe == SurfaceProbes::kClosed) continue;
            Entry entry;
            entry.probe = probe & 0xFFFFFFu;
            entry.direction = link.direction;
            entries_.push_back(entry);
        }
        first_entry_.push_back(static_cast<std::uint32_t>(entries_.size()));
        live_[to] = live_[n], counted_[to] = counted_[n], turns_[to] = turns_[n];
        for (std::size_t w = 0; w < free_words(); ++w)
            free_[to * free_words() + w] = free_[n * free_words() + w];
    });
    probes_.keep(numbers);
    live_.resize(size()), counted_.resize(size()), turns_.resize(size()), free_.resize(size() * free_words());
    live_.shrink_to_fit(), counted_.shrink_to_fit(), turns_.shrink_to_fit(), free_.shrink_to_fit(),
        entries_.shrink_to_fit();
}

std::size_t TransferTable::bytes() const {
    return probes_.bytes() + first_entry_.size() * sizeof(std::uint32_t) + entries_.size() * sizeof(Entry) +
           free_.size() * sizeof(std::uint64_t) + live_.size() + counted_.size() * sizeof(std::uint16_t) +
           turns_.size() * sizeof(Vec2f);
}

bool TransferTable::is_whole() const {
    const std::size_t n = size();
    if (directions_ < 4 || directions_ % SurfaceProbe::kPoints != 0 || directions_ > 256 ||
        !probes_.is_whole() || n > kMaxProbes)
        return false;
    if (first_entry_.size() != n + 1 || first_entry_.front() != 0 || first_entry_.back() != entries_.size() ||
        free_.size() != n * free_words() || live_.size() != n || counted_.size() != n || turns_.size() != n)
        return false;
    if (!std::is_sorted(first_entry_.begin(), first_entry_.end())) return false;
    return std::all_of(entries_.begin(), entries_.end(),
                       [&](Entry e) { return e.probe < n && static_cast<int>(e.direction) < directions_; });
}

}  // namespace hilcam
