#include "render/primary/primary_hits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "render/radiosity/irradiance_cache.h"
#include "render/shading/sample_offsets.h"
#include "render/visibility/visibility_buffer.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// The largest angle between normals of fragments that become one shading point, whose cached light and
// mirrored rays are those of one normal.
constexpr float kNormalsAlike = 0.94f;        // cosine
constexpr float kLeansAlikeNarrow = 0.9998f;  // cosine for surfaces with narrow lobes
constexpr float kFlatTogether = 0.02f;        // sine of the latter: planes that count as one
// If normals turn by this share of a lobe's alpha within a triangle, several are used. At this limit one of
// them is off by 4 % in the lobe's middle (GGX's density, 1 / (1 + t^2)^2 with t = angle over alpha, over a
// quarter of alpha on both sides). Paint counts as a lobe of 1.
constexpr float kMinTurn = 0.5f;
// This many alphas outside of all of them, the lobe reflects a twenty-fifth of the Sun, with little
// difference between them.
constexpr float kFarFromLobe = 2;
// A texture lookup is narrower by this factor than the area it represents, because interpolation between
// texels blurs it again.
constexpr float kTextureWidth = 0.5f;
constexpr float kMinFacing =
    1e-4f;  // smallest cosine of a shading point's normal to the viewer, as in find_surface_frame()
constexpr float kFlattest = 1e-4f;  // smallest sine of elevation at which a coverage map is used

bool has_narrow_lobe(const Bsdf& surface) {
    return surface.material->has_facets() && surface.alpha < kMinCachedAlpha;
}

}  // namespace

std::size_t PrimaryHits::next(std::span<ShadingPoint> points) {
    if (tile_.seen) return next_fragments(points);
    if (std::exchange(begun_, true)) return 0;
    return trace_primary_rays(tile_, points);
}

std::size_t PrimaryHits::next_fragments(std::span<ShadingPoint> points) {
    const PixelBox& box = tile_.box;
    if (!std::exchange(begun_, true)) {
        HILCAM_CHECK((box.x1 - box.x0) * (box.y1 - box.y0) <= PathModel::kMaxSamples &&
                     tile_.samples_per_axis == kVisibilitySamplesAcross);
        uncovered_.fill(tile_.frame.samples.all());
        part_px_ = kVisibilityTile_px / tile_.frame.samples.buffer_px();
        part_ = {box.x0 - part_px_, box.y0, box.x0, box.y0};
    }
    std::size_t count = 0;
    tile_.clusters.clear();
    // Leaves room for a shading point of each surface of coverage maps: kMaxShadingPoints and kMaxSamples
    // differ by that.
    static_assert(CoverageMap::kMaxLayers * kPacketSize <=
                  PathModel::kMaxShadingPoints - PathModel::kMaxSamples + kPacketSize);
    while (count + CoverageMap::kMaxLayers * kPacketSize <= points.size() &&
           tile_.clusters.room() >= 2 * kPacketSize) {
        while (fragment_count_ < kPacketSize && (next_pixel_ < pixels_ || open_next_part()))
            take_next_pixel();
        if (fragment_count_ == 0) {
            // The background is added once, after everything else.
            if (!std::exchange(ended_, true)) add_backdrop(tile_, uncovered_.data());
            break;
        }
        count = make_shading_points(points, count);
    }
    return count;
}

// Opens the next part of the tile in which anything is seen.
bool PrimaryHits::open_next_part() {
    const PixelBox& box = tile_.box;
    const int buffer_px = tile_.frame.samples.buffer_px();
    int x = part_.x0 + part_px_, y = part_.y0;
    for (;; x += part_px_) {
        if (x >= box.x1) x = box.x0, y += part_px_;
        part_ = {x, y, std::min(x + part_px_, box.x1), std::min(y + part_px_, box.y1)};
        if (y >= box.y1) return false;
        if (!tile_.frame.visibility->fill(buffer_px * x, buffer_px * y, *tile_.seen)) continue;
        next_pixel_ = 0, pixels_ = part_px_ * part_px_;
        return true;
    }
}

// Four neighbours in succession: they may share what changes slowly (IndirectCache::add_reflected()).
void PrimaryHits::take_next_pixel() {
    // 16 or 8 pixels: a power of two, because divisions would take a third of the time.
    const auto pairs = static_cast<unsigned>(part_px_ / 2), i = static_cast<unsigned>(next_pixel_++),
               pair = i / 4;
    const int x = part_.x0 + static_cast<int>(2 * (pair & (pairs - 1)) + i % 2);
    const int y = part_.y0 + static_cast<int>(2 * (pair >> std::countr_zero(pairs)) + i / 2 % 2);
    if (x < part_.x1 && y < part_.y1) take_pixel(x, y);
}

void PrimaryHits::take_pixel(int x, int y) {
    const PixelSamples& grid = tile_.frame.samples;
    const auto left = static_cast<std::uint8_t>(x - tile_.box.x0),
               top = static_cast<std::uint8_t>(y - tile_.box.y0);
    const int pixel = top * (tile_.box.x1 - tile_.box.x0) + left;
    const int across = grid.buffer_px();
    PixelFragments seen;
    list_fragments(tile_.seen->ids(across * (x - part_.x0), across * (y - part_.y0)), across, seen);
    uncovered_[static_cast<std::size_t>(pixel)] = seen.nothing;
    if (seen.count == 0) return;
    for (const PixelFragments::Fragment& found : std::span(seen.fragments).first(seen.count)) {
        if (tile_.frame.has_impostors && has_impostor(found.id)) continue;
        fragments_[fragment_count_++] = {found.id, static_cast<std::uint16_t>(pixel), left, top,
                                         found.samples};
    }
    tile_.set_kind(static_cast<std::uint32_t>(pixel), SubpixelKind::kObject);
    tile_.stats.covered_px +=
        static_cast<double>(grid.weight(grid.all() & ~seen.nothing)) * (1.0 / kVisibilitySamples);
}

bool PrimaryHits::has_impostor(std::uint32_t id) const {
    const FrameContext& frame = tile_.frame;
    return frame.has_impostor[frame.visibility->seen(id).shown->object] != 0;
}

// True when a body is in front of what the samples see; they then see the body.
bool PrimaryHits::leave_to_body(std::size_t k) {
    const FrameContext& frame = tile_.frame;
    const Vec3d point = to_double(origins_[k]) + static_cast<double>(hits_.distance[k]) * dirs_[k];
    if (!frame.background->hides_seen(normalized(dirs_[k]), length(point - frame.camera_m))) return false;
    uncovered_[fragments_[k].pixel] |= fragments_[k].samples;
    return true;
}

// Returns the shading point of the same pixel that a fragment belongs to; null: none.
ShadingPoint* PrimaryHits::join(std::span<ShadingPoint> so_far, std::uint32_t pixel, std::uint32_t object,
                                std::uint16_t surface, const SurfaceFrame& surface_frame) {
    for (auto point = so_far.rbegin(); point != so_far.rend() && point->pixel == pixel; ++point) {
        if (point->object != object || point->surface_number != surface || point->back != surface_frame.back)
            continue;
        const float alike = has_narrow_lobe(point->surface) ? kLeansAlikeNarrow : kNormalsAlike;
        if (dot(point->normal, surface_frame.normal) > alike) return &*point;
    }
    return nullptr;
}

// Returns the ray through a place in a fragment's pixel.
PrimaryHits::Aim PrimaryHits::aim_at(const Fragment& fragment, Vec2f place_px) const {
    const FrameContext& frame = tile_.frame;
    const Vec3d dir =
        direction_through(frame, tile_.box.x0 + fragment.x, tile_.box.y0 + fragment.y, place_px);
    const Vec3d eye = eye_m(frame, tile_.box.y0 + fragment.y);
    return {dir,
            frame.start_before_m > 0 ? frame.start_of(normalized(dir), eye - frame.camera_m) : to_float(eye)};
}

// Processes the first fragments, as many as belong to one object.
std::size_t PrimaryHits::look_at_fragments() {
    const FrameContext& frame = tile_.frame;
    const VisibilityBuffer::Shown& shown = *frame.visibility->seen(fragments_[0].id).shown;
    const ObjectSurfaces& surfaces = *(*frame.objects)[shown.object];
    body_m_ = to_float(shown.pose.position_world_m - frame.rays_world_m);
    mesh_ = {shown.mesh.vertices_m.data(), shown.mesh.triangles.data(), surfaces.triangles.data(),
             frame.world_from_body[shown.object]};
    std::size_t n = 0;
    for (; n < std::min<std::size_t>(kPacketSize, fragment_count_); ++n) {
        const Fragment& fragment = fragments_[n];
        const VisibilityBuffer::Seen seen = frame.visibility->seen(fragment.id);
        if (seen.shown != &shown) break;
        places_px_[n] = frame.samples.middle(fragment.samples);
        const Aim aim = aim_at(fragment, places_px_[n]);
        dirs_[n] = aim.dir, origins_[n] = aim.origin_m;
        packet_.triangle[n] = seen.triangle;
        __builtin_prefetch(&shown.mesh.triangles[seen.triangle]);
        __builtin_prefetch(&surfaces.triangles[seen.triangle]);
        if (!surfaces.lod_normals.empty()) __builtin_prefetch(&surfaces.lod_normals[seen.triangle]);
        if (!surfaces.corner_uvs.empty()) {
            __builtin_prefetch(&surfaces.corner_uvs[seen.triangle]);
            __builtin_prefetch(&surfaces.uv_per_m[seen.triangle]);
        }
        packet_.dir.set(n, to_float(aim.dir));
        packet_.origin.set(n, aim.origin_m - body_m_);
    }
    for (std::size_t k = n; k < kPacketSize; ++k) packet_.triangle[k] = packet_.triangle[0];
    packet_.count = n;
    find_surface_frames(mesh_, packet_);
    hits_.object.fill(shown.object);
    hits_.triangle = packet_.triangle;
    hits_.distance = packet_.distance, hits_.u = packet_.u, hits_.v = packet_.v;
    hits_.normal_x = packet_.body_normal.x, hits_.normal_y = packet_.body_normal.y;
    hits_.normal_z = packet_.body_normal.z;
    look_at_samples();
    return n;
}

// True if normals turn so much within a fragment that a single one does not give the sunlight that its lobe
// reflects.
bool PrimaryHits::turns_much(std::size_t k) const {
    const float turn = packet_.turn[k];  // within the triangle, squared
    if (turn == 0) return false;
    const FrameContext& frame = tile_.frame;
    const ObjectSurfaces& object = *(*frame.objects)[hits_.object[k]];
    const Material& material = object.materials[object.triangles[hits_.triangle[k]].surface];
    const float own = object.unflattened(object.triangles[hits_.triangle[k]].surface, material.ggx_alpha);
    const float alpha = material.has_facets() && own > 0 ? own : 1, least = kMinTurn * alpha;
    if (turn <= least * least) return false;
    const Vec3f view_dir = packet_.view_dir.at(k);
    const Vec3f between = normalized(view_dir + to_float(frame.background->sun_world_dir()));
    if (length(between - packet_.normal.at(k)) > std::sqrt(turn) + kFarFromLobe * alpha) return false;
    // If the triangle is wider than the pixel, only a part of it counts.
    const float wide_m = pixel_m(k) / std::max(std::abs(dot(packet_.geometric.at(k), view_dir)), kMinFacing);
    return turn * wide_m * wide_m > least * least * packet_.height[k];
}

// Returns the width of fragment k's pixel at the surface, across its ray.
float PrimaryHits::pixel_m(std::size_t k) const {
    const auto from_m = static_cast<float>(tile_.frame.way_to_start_m());
    return (from_m + packet_.distance[k] * length(packet_.dir.at(k))) /
           static_cast<float>(tile_.frame.geometry.focal_length_px);
}

bool PrimaryHits::is_textured(std::size_t k) const {
    const ObjectSurfaces& object = *(*tile_.frame.objects)[hits_.object[k]];
    return object.materials[object.triangles[hits_.triangle[k]].surface].texture >= 0;
}

// Returns the number of texture lookups that fragment k needs.
std::size_t PrimaryHits::looks_at_texture(std::size_t k, float samples) const {
    constexpr float kPerLook = kVisibilitySamples / 4;  // samples that a lookup represents
    if (samples <= kPerLook || !is_textured(k)) return 1;
    const ObjectSurfaces& object = *(*tile_.frame.objects)[hits_.object[k]];
    const std::uint32_t triangle = hits_.triangle[k];
    const int texture = object.materials[object.triangles[triangle].surface].texture;
    const float texels = pixel_m(k) * object.uv_per_m[triangle] *
                         static_cast<float>((*object.textures)[static_cast<std::size_t>(texture)].width());
    // Within a texel colours are linear.
    return texels <= 1 ? 1 : static_cast<std::size_t>(std::ceil(samples / kPerLook));
}

// Adds a fragment to those that are looked at from several of their samples, as far apart as possible.
// Returns the number of looks; zero if one is enough.
std::size_t PrimaryHits::add_looks(std::size_t k) {
    const Fragment& fragment = fragments_[k];
    const PixelSamples& grid = tile_.frame.samples;
    const float samples = grid.weight(fragment.samples);
    const auto seen_by = static_cast<std::size_t>(std::popcount(fragment.samples));
    turns_[k] = seen_by > 1 && turns_much(k);
    const std::size_t wanted = turns_[k] ? kLooks : looks_at_texture(k, samples);
    const std::size_t count = std::min({kLooks, seen_by, wanted});
    if (count < 2) return 0;
    if (looked_at_.count + count > kPacketSize) find_looks(first_look_[k] - looked_at_.count);
    SampleMask left = fragment.samples, apart = left;
    for (std::size_t i = looked_at_.count; i < looked_at_.count + count; ++i) {
        const int sample = next_sample_across(grid, apart, left);
        left &= ~(SampleMask{1} << sample);
        const Aim aim = aim_at(fragment, grid.place(sample));
        looked_at_.triangle[i] = packet_.triangle[k];
        looked_at_.dir.set(i, to_float(aim.dir));
        looked_at_.origin.set(i, aim.origin_m - body_m_);
    }
    looked_at_.count += count;
    return count;
}

// Finds what the requested looks meet; `first` is the index of the first of them.
void PrimaryHits::find_looks(std::size_t first) {
    if (looked_at_.count == 0) return;
    for (std::size_t i = looked_at_.count; i < kPacketSize; ++i)
        looked_at_.triangle[i] = looked_at_.triangle[0];
    find_surface_frames(mesh_, looked_at_);
    for (std::size_t i = 0; i < looked_at_.count; ++i) {
        look_normals_[first + i] = looked_at_.normal.at(i);
        look_places_[first + i] = {looked_at_.u[i], looked_at_.v[i]};
    }
    looked_at_.count = 0;
}

// Looks at those fragments of the packet that need it, many at a time: one fragment alone would fill a
// quarter of the vectors.
void PrimaryHits::look_at_samples() {
    first_look_[0] = 0;
    for (std::size_t k = 0; k < packet_.count; ++k) first_look_[k + 1] = first_look_[k] + add_looks(k);
    find_looks(first_look_[packet_.count] - looked_at_.count);
}

// Returns a texture's colours in fragment k. A single lookup as wide as the pixel would blur it: at Nyquist's
// frequency a pixel keeps the contrast sinc(1/2) = 0.64, but texels of its width with linear interpolation
// keep sinc(1/2)^3 = 0.26 (sinc x = sin(pi x) / (pi x)).
Spectrum PrimaryHits::texture_of(std::size_t k, const ShadingPoint& point) const {
    const auto looks = looks_of(k, look_places_);
    const std::uint32_t triangle = hits_.triangle[k];
    const float of_pixel = tile_.frame.samples.weight(fragments_[k].samples) / kVisibilitySamples;
    const float per_look = 1 / static_cast<float>(std::max<std::size_t>(looks.size(), 1));
    const float share = kTextureWidth * std::sqrt(per_look * of_pixel);
    if (looks.empty()) return texture_at(tile_.frame, point, triangle, {hits_.u[k], hits_.v[k]}, share);
    Spectrum sum;
    for (const Vec2f place : looks) sum += per_look * texture_at(tile_.frame, point, triangle, place, share);
    return sum;
}

// Gives a shading point a share of the colours of fragment k, which has joined it.
void PrimaryHits::mix_colors(std::size_t k, float share, ShadingPoint& point) const {
    const bool textured = is_textured(k);
    const ObjectSurfaces& object = *(*tile_.frame.objects)[point.object];
    if (!textured && object.corner_colors.empty()) return;
    Bsdf& surface = point.surface;
    const Spectrum base = surface.base, highlight = surface.highlight;
    surface.base = surface.material->base, surface.highlight = surface.material->highlight;
    if (!object.corner_colors.empty())
        paint(tile_.frame.bands->spectrum(object.color_at(hits_.triangle[k], hits_.u[k], hits_.v[k])), point);
    if (textured) paint(texture_of(k, point), point);
    surface.base = (1 - share) * base + share * surface.base;
    surface.highlight = (1 - share) * highlight + share * surface.highlight;
}

std::size_t PrimaryHits::make_shading_points(std::span<ShadingPoint> points, std::size_t count) {
    const FrameContext& frame = tile_.frame;
    const std::size_t n = look_at_fragments();
    const float pixel_rad = 1 / static_cast<float>(frame.geometry.focal_length_px);
    const auto from_m = static_cast<float>(frame.way_to_start_m());
    const std::vector<PackedTriangle>& triangles = (*frame.objects)[hits_.object[0]]->triangles;
    for (std::size_t k = 0; k < n; ++k) {
        if (frame.bodies_may_hide && leave_to_body(k)) continue;
        const Fragment& fragment = fragments_[k];
        const float samples = frame.samples.weight(fragment.samples);
        const Vec3f dir = packet_.dir.at(k);
        SurfaceFrame surface_frame{packet_.geometric.at(k), packet_.normal.at(k), packet_.view_dir.at(k),
                                   packet_.back[k] != 0};
        // Its normal is too small to be squared, so it is processed alone.
        if (surface_frame.geometric_normal == Vec3f{} &&
            !find_surface_frame(frame, hits_, static_cast<int>(k), dir, surface_frame))
            continue;
        const ObjectSurfaces& surfaces = *(*frame.objects)[hits_.object[k]];
        const std::uint8_t coplanar_group = surfaces.triangles[hits_.triangle[k]].coplanar_group;
        const CoverageMap* coverage_map =
            coplanar_group > 1 ? &(*surfaces.coverage_maps)[coplanar_group - 2u] : nullptr;
        const float facing = coverage_map ? dot(shown(*coverage_map).normal, surface_frame.view_dir) : 0.0f;
        if (facing > kFlattest) {
            const std::size_t before = count;
            count = make_covered_points(k, surface_frame, points, count);
            if (count > before) continue;
        }
        ShadingPoint* const joined = coverage_map ? nullptr
                                                  : join(points.first(count), fragment.pixel, hits_.object[k],
                                                         triangles[hits_.triangle[k]].surface, surface_frame);
        if (joined) {
            take_in(k, surface_frame, *joined);
            continue;
        }
        ShadingPoint& point = points[count++];
        make_shading_point(frame, hits_, static_cast<int>(k), surface_frame, origins_[k], dir, 0,
                           {pixel_rad * from_m, pixel_rad}, point);
        // Seen edge-on, the parts on top hide the ground.
        if (facing > 0) set_surface(frame, coverage_map->surface[1], point);
        if (is_textured(k)) paint(texture_of(k, point), point);
        finish(k, samples, frame.samples.moments(fragment.samples), places_px_[k], point);
        tile_.clusters.add(
            frame,
            {surface_frame.geometric_normal, surface_frame.normal, point.start(), samples, fragment.samples},
            hits_.triangle[k], true, turns_of(k), point);
    }
    std::copy(fragments_.begin() + static_cast<std::ptrdiff_t>(n),
              fragments_.begin() + static_cast<std::ptrdiff_t>(fragment_count_), fragments_.begin());
    fragment_count_ -= n;
    return count;
}

// Joins fragment k to a similar shading point.
void PrimaryHits::take_in(std::size_t k, const SurfaceFrame& surface_frame, ShadingPoint& point) {
    const FrameContext& frame = tile_.frame;
    const SampleMask seen_by = fragments_[k].samples;
    const float samples = frame.samples.weight(seen_by);
    const Vec3f point_m = origins_[k] + hits_.distance[k] * packet_.dir.at(k);
    tile_.clusters.add(frame,
                       {surface_frame.geometric_normal, surface_frame.normal,
                        point_m + point.offset_m * surface_frame.geometric_normal, samples, seen_by},
                       hits_.triangle[k], false, turns_of(k), point);
    // Its samples become ray starts, too, if it is nearly in the shading point's plane; these starts are
    // raised by twice the difference. Otherwise rays keep their starts, because higher ones would miss
    // shadows of near things.
    const Vec3f way_m = point_m - point.point_m;
    const float above_m = std::abs(dot(way_m, point.geometric_normal));
    if (above_m < kFlatTogether * length(way_m)) {
        point.samples |= seen_by;
        point.lift_m = std::max(point.lift_m, 2 * above_m);
    }
    // Cached light and lobes are looked up once, with the mean normal; clusters and mirrors keep their own.
    const Vec3f mean = normalized(point.weight_samples * point.normal + samples * surface_frame.normal);
    if (!has_narrow_lobe(point.surface) && dot(mean, point.view_dir) > kMinFacing) point.normal = mean;
    // The same factor for all bins, apart from the air in front.
    const float all = point.weight_samples + samples;
    mix_colors(k, samples / all, point);
    point.throughput = (all / point.weight_samples) * point.throughput;
    point.moments = (point.weight_samples / all) * point.moments;
    point.moments += (samples / all) * frame.samples.moments(seen_by);
    point.weight_samples = all;
}

// Sets the pixel data of a shading point that is part of fragment k.
void PrimaryHits::finish(std::size_t k, float samples, SubpixelMoments moments, Vec2f place_px,
                         ShadingPoint& point) {
    const Fragment& fragment = fragments_[k];
    point.pixel = fragment.pixel;
    point.sample = static_cast<std::uint16_t>(std::countr_zero(fragment.samples));
    point.depth = 1;
    point.samples = fragment.samples;
    point.place_px = place_px;
    point.lift_m = 0;
    point.throughput = {};
    std::fill_n(point.throughput.bin.begin(), tile_.frame.bins, samples);
    point.weight_samples = samples;
    point.moments = moments;
    add_air_before(tile_, dirs_[k], point);
}

}  // namespace hilcam
