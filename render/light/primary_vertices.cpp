#include "render/light/primary_vertices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "render/light/kept_light.h"
#include "render/light/primary_rays.h"
#include "render/light/visibility_buffer.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Where a ray through the middle of some samples meets a triangle that they see.
struct Meeting {
    float distance, u, v;
    Vec3f normal;  // of twice the triangle's area
};

// Moeller & Trumbore (J. Graphics Tools 2(1), 1997), kept to the triangle: the samples' middle may lie beside
// it by a rounding, and a triangle seen from its edge has no place of its own.
Meeting meet(Vec3f a, Vec3f b, Vec3f c, Vec3f origin, Vec3f dir) {
    const Vec3f e1 = b - a, e2 = c - a, from_a = origin - a;
    const Vec3f p = cross(dir, e2), q = cross(from_a, e1);
    const float volume = dot(e1, p);
    float u = dot(from_a, p) / volume, v = dot(dir, q) / volume;
    if (!(std::isfinite(u) && std::isfinite(v))) u = v = 1.0f / 3;
    u = std::clamp(u, 0.0f, 1.0f), v = std::clamp(v, 0.0f, 1.0f);
    if (u + v > 1) {
        const float sum = u + v;
        u /= sum, v /= sum;
    }
    const Vec3f at = u * e1 + v * e2 - from_a;
    return {dot(at, dir) / dot(dir, dir), u, v, cross(e1, e2)};
}

// Where to look for what some samples see, from their pixel's corner: at the one next to their middle. The
// middle itself may see something else.
Vec2f middle_of(std::uint32_t samples) {
    float x = 0, y = 0;
    for (std::uint32_t rest = samples; rest; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        x += sample_x(i), y += sample_y(i);
    }
    const float share = 1 / static_cast<float>(std::popcount(samples));
    x *= share, y *= share;
    if (samples == 0xFFFFu) return {x, y};
    float least = 2;
    int nearest = 0;
    for (std::uint32_t rest = samples; rest; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        const float dx = sample_x(i) - x, dy = sample_y(i) - y;
        if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, nearest = i;
    }
    return {sample_x(nearest), sample_y(nearest)};
}

// How far two facets may lean against each other to be one vertex: its kept light and its mirrored rays are
// those of one of them.
constexpr float kLeansAlike = 0.94f;          // cosine
constexpr float kLeansAlikeNarrow = 0.9998f;  // of surfaces with narrow lobes
constexpr float kSame = 0.999998f;

}  // namespace

std::size_t PrimaryVertices::next(std::span<Vertex> vertices) {
    if (tile_.seen) return next_fragments(vertices);
    if (std::exchange(begun_, true)) return 0;
    return trace_primary_rays(tile_, vertices);
}

std::size_t PrimaryVertices::next_fragments(std::span<Vertex> vertices) {
    const PixelBox& box = tile_.box;
    if (!std::exchange(begun_, true)) {
        HILCAM_CHECK((box.x1 - box.x0) * (box.y1 - box.y0) <= PathModel::kMostSamples &&
                     tile_.samples_per_axis == kVisibilitySamplesAcross);
        uncovered_.fill(kVisibilitySamples);
        part_ = {box.x0 - kVisibilityTile_px, box.y0, box.x0, box.y0};
        y_ = part_.y1;
    }
    std::size_t count = 0;
    facet_count_ = 0;
    while (count + kPacketSize <= vertices.size() &&
           facet_count_ + 2 * kPacketSize <= SeenMemory::kMostFacets) {
        while (fragment_count_ < kPacketSize && (y_ < part_.y1 || open_next_part())) {
            take_pixel(x_, y_);
            if (++x_ == part_.x1) x_ = part_.x0, ++y_;
        }
        if (fragment_count_ == 0) {
            // Whatever comes last, the background comes once.
            if (!std::exchange(ended_, true)) add_backdrop(tile_, uncovered_.data());
            break;
        }
        count = make_vertices(vertices, count);
    }
    return count;
}

// The next part of the tile in which anything is seen.
bool PrimaryVertices::open_next_part() {
    const PixelBox& box = tile_.box;
    int x = part_.x0 + kVisibilityTile_px, y = part_.y0;
    for (;; x += kVisibilityTile_px) {
        if (x >= box.x1) x = box.x0, y += kVisibilityTile_px;
        part_ = {x, y, std::min(x + kVisibilityTile_px, box.x1), std::min(y + kVisibilityTile_px, box.y1)};
        if (y >= box.y1) {
            y_ = part_.y1;
            return false;
        }
        if (!tile_.frame.visibility->fill(x, y, tile_.seen->samples)) continue;
        x_ = x, y_ = y;
        return true;
    }
}

void PrimaryVertices::take_pixel(int x, int y) {
    const std::uint32_t* ids = tile_.seen->samples.ids(x - part_.x0, y - part_.y0);
    const int pixel = (y - tile_.box.y0) * (tile_.box.x1 - tile_.box.x0) + x - tile_.box.x0;
    std::uint32_t rest = 0;
    for (std::uint32_t i = 0; i < kVisibilitySamples; ++i)
        rest |= (ids[i] != VisibilityTile::kNothing ? 1u : 0u) << i;
    const int covered = std::popcount(rest);
    uncovered_[static_cast<std::size_t>(pixel)] = static_cast<std::uint8_t>(kVisibilitySamples - covered);
    tile_.stats.covered_px += covered * (1.0 / kVisibilitySamples);
    const std::size_t first = fragment_count_;
    while (rest != 0) {
        const std::uint32_t id = ids[std::countr_zero(rest)];
        std::uint32_t same = 0;
        for (std::uint32_t i = 0; i < kVisibilitySamples; ++i) same |= (ids[i] == id ? 1u : 0u) << i;
        fragments_[fragment_count_++] = {id, static_cast<std::uint16_t>(same),
                                         static_cast<std::uint16_t>(pixel)};
        rest &= ~same;
    }
    // The greatest first: others join it.
    std::sort(fragments_.begin() + first, fragments_.begin() + fragment_count_,
              [](const Fragment& a, const Fragment& b) {
                  const int more = std::popcount(a.samples), less = std::popcount(b.samples);
                  return more != less ? more > less : a.samples < b.samples;
              });
}

// A body stands before what the samples see: they see the body.
void PrimaryVertices::leave_to_body(HitPacket& hits, std::size_t k, Vec3f origin, Vec3d dir) {
    const FrameView& frame = tile_.frame;
    const Vec3d point = to_double(origin) + static_cast<double>(hits.distance[k]) * dir;
    if (!frame.background->hides_seen(normalized(dir), length(point - frame.camera_m))) return;
    hits.object[k] = HitPacket::kMiss;
    const auto samples = static_cast<std::uint8_t>(std::popcount(std::uint32_t{fragments_[k].samples}));
    std::uint8_t& uncovered = uncovered_[fragments_[k].pixel];
    uncovered = static_cast<std::uint8_t>(uncovered + samples);
}

// The vertex among those of the same pixel that a fragment is part of; null: none.
Vertex* PrimaryVertices::join(std::span<Vertex> so_far, std::uint32_t pixel, std::uint32_t object,
                              std::uint16_t surface, const Lie& lie) {
    for (auto vertex = so_far.rbegin(); vertex != so_far.rend() && vertex->pixel == pixel; ++vertex) {
        if (vertex->object != object || vertex->surface_number != surface || vertex->back != lie.back)
            continue;
        const bool narrow = vertex->surface.material->has_facets() && vertex->surface.alpha < kNarrowestKept;
        if (dot(vertex->normal, lie.normal) > (narrow ? kLeansAlikeNarrow : kLeansAlike)) return &*vertex;
    }
    return nullptr;
}

void PrimaryVertices::add_facet(Vertex& vertex, const Lie& lie, Vec3f start_m, float samples) {
    const auto add = [&](Vec3f geometric_normal, Vec3f normal, Vec3f from_m, float of) {
        Facet& facet = tile_.seen->facets[facet_count_++];
        facet = {geometric_normal, normal, from_m, of, vertex.facets};
        vertex.facets = &facet;
    };
    if (!vertex.facets) {
        if (dot(vertex.normal, lie.normal) > kSame) return;
        add(vertex.geometric_normal, vertex.normal, vertex.start(), vertex.weight_samples);
    }
    add(lie.geometric_normal, lie.normal, start_m, samples);
}

std::size_t PrimaryVertices::make_vertices(std::span<Vertex> vertices, std::size_t count) {
    const FrameView& frame = tile_.frame;
    const LinearRays& rays = *frame.rays->linear();
    const Vec3d corner = rays.corner + tile_.box.x0 * rays.right + tile_.box.y0 * rays.down;
    const int width = tile_.box.x1 - tile_.box.x0;
    const auto n = static_cast<int>(std::min<std::size_t>(kPacketSize, fragment_count_));
    HitPacket hits;
    std::array<Vec3d, kPacketSize> dirs;
    std::array<Vec3f, kPacketSize> origins;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
        const Fragment& fragment = fragments_[k];
        const Vec2f at = middle_of(fragment.samples);
        dirs[k] = corner +
                  static_cast<double>(static_cast<float>(fragment.pixel % width) + at.x) * rays.right +
                  static_cast<double>(static_cast<float>(fragment.pixel / width) + at.y) * rays.down;
        origins[k] =
            frame.start_before_m > 0 ? frame.start_of(normalized(dirs[k])) : to_float(frame.camera_m);
        const VisibilityBuffer::Seen seen = frame.visibility->seen(fragment.id);
        const Mat3f body_from_world = transposed(frame.world_from_body[seen.shown->object]);
        const Vec3f body_m = to_float(seen.shown->pose.position_world_m - frame.rays_world_m);
        const TriangleCorners& corners = seen.shown->mesh.triangles[seen.triangle];
        const std::span<const Vec3f> points_m = seen.shown->mesh.vertices_m;
        const Meeting met =
            meet(points_m[corners[0]], points_m[corners[1]], points_m[corners[2]],
                 body_from_world * (origins[k] - body_m), body_from_world * to_float(dirs[k]));
        hits.object[k] = seen.shown->object, hits.triangle[k] = seen.triangle;
        hits.distance[k] = met.distance, hits.u[k] = met.u, hits.v[k] = met.v;
        hits.normal_x[k] = met.normal.x, hits.normal_y[k] = met.normal.y, hits.normal_z[k] = met.normal.z;
        if (frame.bodies_may_hide) leave_to_body(hits, k, origins[k], dirs[k]);
    }
    prefetch_vertices(frame, hits, n);
    const float pixel_rad = 1 / static_cast<float>(frame.geometry.focal_length_px);
    const float from_m =
        frame.start_before_m > 0 ? static_cast<float>(length(frame.start_at_m - frame.camera_m)) : 0.0f;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
        if (hits.object[k] == HitPacket::kMiss) continue;
        const Fragment& fragment = fragments_[k];
        const auto samples = static_cast<float>(std::popcount(std::uint32_t{fragment.samples}));
        const Vec3f dir = to_float(dirs[k]);
        Lie lie;
        if (!find_lie(frame, hits, static_cast<int>(k), dir, lie)) continue;
        const std::uint16_t surface = (*frame.objects)[hits.object[k]]->triangles[hits.triangle[k]].surface;
        Vertex* const joined = join(vertices.first(count), fragment.pixel, hits.object[k], surface, lie);
        if (joined) {
            const Vec3f start_m =
                origins[k] + hits.distance[k] * dir + joined->offset_m * lie.geometric_normal;
            add_facet(*joined, lie, start_m, samples);
            // Alike in all bins, but for the air before it.
            joined->weight = ((joined->weight_samples + samples) / joined->weight_samples) * joined->weight;
            joined->weight_samples += samples;
            continue;
        }
        Vertex& vertex = vertices[count];
        if (!make_vertex(frame, hits, static_cast<int>(k), origins[k], dir, 0,
                         {pixel_rad * from_m, pixel_rad}, vertex))
            continue;
        vertex.pixel = fragment.pixel;
        vertex.sample = static_cast<std::uint16_t>(std::countr_zero(std::uint32_t{fragment.samples}));
        vertex.depth = 1;
        vertex.weight_samples = samples;
        std::fill_n(vertex.weight.bin.begin(), frame.bins, samples);
        add_air_before(tile_, dirs[k], vertex);
        ++count;
    }
    std::copy(fragments_.begin() + n, fragments_.begin() + fragment_count_, fragments_.begin());
    fragment_count_ -= static_cast<std::size_t>(n);
    return count;
}

}  // namespace hilcam
