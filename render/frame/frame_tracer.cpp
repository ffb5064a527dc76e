#include "render/frame/frame_tracer.h"

#include <algorithm>
#include <cmath>

#include "render/frame/finite_light.h"
#include "render/glossy/glossy_reuse.h"
#include "render/ground_shading/ground_light.h"
#include "render/paths/glossy_rays.h"

namespace hilcam {
namespace {

void fill_zero(RadianceImage& radiance, const PixelBox& box) {
    for (int p = 0; p < radiance.planes(); ++p)
        for (int y = box.y0; y < box.y1; ++y)
            std::fill(radiance.row(y, p).begin() + box.x0, radiance.row(y, p).begin() + box.x1, 0.0f);
}

// Lobes that a tile has room for, per sample; the visibility buffer counts one sample a pixel. Tiles in which
// several surfaces meet in each pixel need 1.3. A lobe without room has four rays of its own.
constexpr std::size_t kLobesPerSample = 2;

// The two ways to store a value: set or add.
constexpr auto kSet = [](float& to, float value) { to = value; };
constexpr auto kAdd = [](float& to, float value) { to += value; };

// share: factor on the pixels' values. value_of: of a pixel, for a plane of the image.
template <class Put, class ValueOf>
void put_planes(std::span<const Spectrum> pixels, float share, const PixelBox& box, RadianceImage& radiance,
                const Put& put, const ValueOf& value_of) {
    // In groups of pixels: a whole tile, plane by plane, would pass through the nearest cache once per plane.
    constexpr int kTogether = 16;
    const int width = box.x1 - box.x0;
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = 0; x < width; x += kTogether) {
            const Spectrum* in = pixels.data() + (y - box.y0) * width + x;
            const int count = std::min(kTogether, width - x);
            for (int plane = 0; plane < radiance.planes(); ++plane) {
                float* out = radiance.row(y, plane).data() + box.x0 + x;
                for (int i = 0; i < count; ++i) put(out[i], share * value_of(in[i], plane));
            }
        }
}
template <class Put>
void put_pixels(std::span<const Spectrum> pixels, float share, const PixelBox& box, RadianceImage& radiance,
                const Put& put) {
    const std::span<const Spectrum> responses = radiance.responses();
    if (responses.empty())
        put_planes(pixels, share, box, radiance, put,
                   [](const Spectrum& pixel, int bin) { return pixel[bin]; });
    else
        put_planes(pixels, share, box, radiance, put, [&](const Spectrum& pixel, int channel) {
            return sum_of_products(responses[static_cast<std::size_t>(channel)], pixel);
        });
}
void write(std::span<const Spectrum> pixels, float share, const PixelBox& box, RadianceImage& radiance) {
    put_pixels(pixels, share, box, radiance, kSet);
}

void copy(const RadianceImage& from, const PixelBox& box, RadianceImage& to) {
    for (int p = 0; p < from.planes(); ++p)
        for (int y = box.y0; y < box.y1; ++y)
            std::copy(from.row(y, p).begin() + box.x0, from.row(y, p).begin() + box.x1,
                      to.row(y, p).begin() + box.x0);
}

template <class Put>
void put_differences(const Tile& tile, float share, SubpixelLight& moments, const Put& put) {
    const PixelBox& box = tile.box;
    const auto width = static_cast<std::size_t>(box.x1 - box.x0);
    const float* in = tile.moments.data();
    for (int channel = 0; channel < static_cast<int>(tile.moment_responses.size()); ++channel)
        for (int difference = 0; difference < SubpixelLight::kDifferences; ++difference)
            for (int y = box.y0; y < box.y1; ++y, in += width) {
                float* out = moments.row(y, difference, channel).data() + box.x0;
                for (std::size_t x = 0; x < width; ++x) put(out[x], share * in[x]);
            }
}

// Writes a part of a block. Returns false, and writes nothing, if no pixel's differences are known and
// may_leave is set.
bool write(const Tile& tile, float share, bool may_leave, SubpixelLight& moments) {
    if (may_leave && std::all_of(tile.kinds.begin(), tile.kinds.end(),
                                 [](SubpixelKind kind) { return kind == SubpixelKind::kSmooth; }))
        return false;
    put_differences(tile, share, moments, kSet);
    const PixelBox& box = tile.box;
    const auto width = static_cast<std::size_t>(box.x1 - box.x0);
    for (int y = box.y0; y < box.y1; ++y)
        std::copy_n(tile.kinds.begin() + (y - box.y0) * static_cast<std::ptrdiff_t>(width), width,
                    moments.kinds(y).begin() + box.x0);
    return true;
}

std::size_t pool_slots() { return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()); }

// Sets pixels and differences whose light is not finite to zero, and counts them.
void leave_out_not_finite(Tile& tile) {
    const std::uint64_t left_out = leave_out_not_finite(tile.pixels);
    if (left_out == 0) return;
    tile.stats.not_finite += left_out;
    std::replace_if(
        tile.moments.begin(), tile.moments.end(), [](float light) { return !std::isfinite(light); }, 0.0f);
}

// A pixel whose light is not finite is dark in all of its parts.
void leave_out_not_finite(std::span<const Spectrum> pixels, const TileParts& parts) {
    for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
        for (std::size_t i = 0; i < kImageParts && !is_finite(pixels[pixel]); ++i)
            parts.of(static_cast<LightPart>(i))[pixel] = {};
}

}  // namespace

FrameTracer::FrameTracer(const ImageGeometry& geometry, const Modules& modules,
                         std::span<const RenderQuality> levels)
    : width_(geometry.padded_width()), height_(geometry.padded_height()) {
    int max_tiles = 0;
    bool buffer = false, ground = false;
    for (const RenderQuality& quality : levels) {
        // Samples of the visibility buffer need no memory of a path model.
        const bool rays = !quality.uses_buffer();
        const int edge_px = tile_edge_px(rays ? static_cast<int>(quality.samples_per_axis) : 1);
        const std::size_t set = path_set(modules, quality.path_model);
        for (const auto& model : path_sets_[set].models)
            model->reserve_depth(static_cast<int>(quality.max_depth));
        levels_.push_back({quality, set, TileGrid(width_, height_, edge_px)});
        max_tiles = std::max(max_tiles, levels_.back().tiles.size());
        buffer = buffer || !rays, ground = ground || quality.sees_ground();
        ground_has_steps_ = ground_has_steps_ || (quality.sees_ground() && quality.ground_step_px > 1);
    }
    tile_stats_.resize(static_cast<std::size_t>(max_tiles));
    tile_pixels_.resize(pool_slots(), std::vector<Spectrum>(PathModel::kMaxSamples));
    if (buffer)
        seen_.resize(pool_slots()), penumbrae_.resize(pool_slots()), tile_moments_.resize(pool_slots()),
            tile_kinds_.resize(pool_slots());
    if (ground) ground_seen_.resize(pool_slots());
    if (std::any_of(path_sets_.begin(), path_sets_.end(),
                    [](const PathSet& set) { return set.models.front()->uses_indirect_cache(); }))
        glossy_ = GlossyBuffer(width_, height_, static_cast<std::size_t>(max_tiles),
                               kLobesPerSample * PathModel::kMaxSamples);
    clusters_.resize(pool_slots());
}

FrameTracer::Paths FrameTracer::make_paths(const Modules& modules, const std::string& name) {
    Paths paths;
    for (std::size_t i = 0; i < pool_slots(); ++i) paths.push_back(make_path_model(modules, name));
    return paths;
}

// Levels with the same path model share a set.
std::size_t FrameTracer::path_set(const Modules& modules, const std::string& name) {
    for (std::size_t i = 0; i < path_sets_.size(); ++i)
        if (path_sets_[i].name == name) return i;
    path_sets_.push_back({name, make_paths(modules, name)});
    return path_sets_.size() - 1;
}

void FrameTracer::use_level(std::size_t level) {
    HILCAM_CHECK(level < levels_.size());
    level_ = level;
}

void FrameTracer::keep_parts(PartsBuffer* buffer, PixelRecord* record) {
    HILCAM_CHECK(!buffer || buffer->tile_sums.size() == slots());
    parts_ = buffer, record_ = record;
}

double FrameTracer::share_done() const {
    const int all = tiles_all_.load(std::memory_order_relaxed);
    return all > 0 ? 1.0 * tiles_done_.load(std::memory_order_relaxed) / all : 0;
}

TileStats FrameTracer::trace(const FrameSetup& setup, RadianceImage& radiance) {
    // Tiles smaller than the image's blocks would share a mark, so marks stay off.
    const bool marks = levels_[level_].tiles.edge_px() == RadianceImage::kBlock_px;
    if (!marks) radiance.clear_marks();
    find_moments(setup, marks, radiance);
    for (GroundSeen& seen : ground_seen_) seen.x_px = seen.y_px = -1;
    if (parts_) parts_->parts.clear();
    if (record_) record_->entries.clear();
    TileStats sum = trace_places(setup.frame(), radiance);
    const int all = levels_[level_].tiles.size();
    tiles_done_.store(0, std::memory_order_relaxed);
    tiles_all_.store(all, std::memory_order_relaxed);
    for_each_tile([&](int index, const PixelBox& tile, std::size_t slot) {
        TileStats& stats = tile_stats_[static_cast<std::size_t>(index)];
        const bool anything = setup.can_see_anything(tile);
        const bool was_dark = radiance.dark(tile.x0, tile.y0);
        if (marks) radiance.mark_dark(tile.x0, tile.y0, !anything);
        stats = {};
        if (moments_) moments_->mark_unknown(tile.x0, tile.y0, true);
        if (glossy_.parts() > 0) glossy_.skip(static_cast<std::size_t>(index));
        if (anything)
            trace_tile(setup, index, slot, radiance);
        else if (!was_dark)
            fill_zero(radiance, tile);
        tiles_done_.fetch_add(1, std::memory_order_relaxed);
    });
    if (glossy_.parts() > 0 && setup.frame().indirect) add_glossy(setup.frame(), radiance);
    sum += sum_of_stats(all);
    return sum;
}

// Adds the light of lobes with rays, once all rays are finished.
void FrameTracer::add_glossy(const FrameContext& frame, RadianceImage& radiance) {
    for_each_tile([&](int index, const PixelBox&, std::size_t slot) {
        const GlossyBuffer::Part& part = glossy_.part(static_cast<std::size_t>(index));
        if (!part.points().empty())
            add_glossy_of(frame, part, slot, tile_stats_[static_cast<std::size_t>(index)], radiance);
    });
}

TileStats FrameTracer::sum_of_stats(int tiles) const {
    TileStats sum;
    for (int i = 0; i < tiles; ++i) sum += tile_stats_[static_cast<std::size_t>(i)];
    return sum;
}

// Frames from the visibility buffer know where in their pixels light falls.
void FrameTracer::find_moments(const FrameSetup& setup, bool marks, RadianceImage& radiance) {
    SubpixelLight* const moments = radiance.moments();
    moments_ = moments && marks && quality().uses_buffer() && setup.frame().visibility ? moments : nullptr;
    if (moments) moments->set_used(moments_ != nullptr);
    if (!moments_) return;
    const std::size_t floats =
        PathModel::kMaxSamples * SubpixelLight::kDifferences * moments->responses().size();
    for (std::vector<float>& of_tile : tile_moments_) of_tile.resize(floats);
    for (std::vector<SubpixelKind>& of_tile : tile_kinds_) of_tile.resize(PathModel::kMaxSamples);
}

void FrameTracer::trace_tile(const FrameSetup& setup, int index, std::size_t slot, RadianceImage& radiance) {
    const PixelBox box = levels_[level_].tiles[index];
    TileStats& stats = tile_stats_[static_cast<std::size_t>(index)];
    if (setup.frame().ground && setup.frame().ground_step_px > 1 && places_->give(box, radiance)) {
        stats.covered_px += (box.x1 - box.x0) * (box.y1 - box.y0);
        if (parts_ && parts_->parts.has(LightPart::kSun))
            copy(radiance, box, parts_->parts.of(LightPart::kSun));
        return;
    }
    int n = setup.samples_in(box);
    VisibilityTile* seen = nullptr;
    if (quality().uses_buffer() && n <= quality().pixel_samples().across()) {
        n = kVisibilitySamplesAcross;
        if (setup.frame().visibility) seen = &seen_[slot];
    }
    const int edge = tile_edge_px(seen ? 1 : n);
    // A tile that is traced in several parts, because it has many rays, cannot store lobes.
    GlossyBuffer::Part* const glossy =
        glossy_.parts() > 0 && edge >= box.x1 - box.x0 && edge >= box.y1 - box.y0
            ? &glossy_.begin(static_cast<std::size_t>(index), box, 1 / static_cast<float>(n * n))
            : nullptr;
    for (int y = box.y0; y < box.y1; y += edge)
        for (int x = box.x0; x < box.x1; x += edge) {
            const PixelBox part{x, y, std::min(x + edge, box.x1), std::min(y + edge, box.y1)};
            trace_part(setup.frame(), part, n, slot, seen, glossy, stats, radiance);
        }
}

// Null if none of the ground is there.
const VisibilityTile* FrameTracer::ground_at(const FrameContext& frame, const PixelBox& box,
                                             std::size_t slot) {
    GroundSeen& seen = ground_seen_[slot];
    const int x = box.x0 / kGroundTile * kVisibilityTile_px, y = box.y0 / kGroundTile * kVisibilityTile_px;
    if (seen.x_px != x || seen.y_px != y)
        seen.x_px = x, seen.y_px = y, seen.any = frame.ground->fill(x, y, seen.tile);
    return seen.any ? &seen.tile : nullptr;
}

// Traces the frame's ground buffer if its places are not the picture's pixels. The first frame allocates
// memory, whatever its level.
TileStats FrameTracer::trace_places(const FrameContext& frame, const RadianceImage& radiance) {
    if (ground_has_steps_ && !(places_ && places_->has_room_for(radiance))) places_.emplace(radiance);
    if (!frame.ground || frame.ground_step_px == 1) return {};
    const TileGrid tiles(places_->light().width(), places_->light().height(), GroundUpsampler::kTile);
    for_each(tiles, [&](int index, const PixelBox& tile, std::size_t slot) {
        trace_places_of(frame, tile, slot, tile_stats_[static_cast<std::size_t>(index)]);
    });
    return sum_of_stats(tiles.size());
}

void FrameTracer::trace_places_of(const FrameContext& frame, const PixelBox& box, std::size_t slot,
                                  TileStats& stats) {
    stats = {};
    const std::span<Spectrum> pixels(tile_pixels_[slot].data(),
                                     static_cast<std::size_t>((box.x1 - box.x0) * (box.y1 - box.y0)));
    std::fill(pixels.begin(), pixels.end(), Spectrum{});
    Tile tile{frame, box, 1, pixels, stats, clusters_[slot]};
    tile.ground = ground_at(frame, box, slot);
    const bool known = tile.ground && add_ground_light(tile);
    stats.not_finite += leave_out_not_finite(pixels);
    if (known) write(pixels, 1, box, places_->light());
    places_->set_known(box, known);
    stats.covered_px = 0;  // pixels are counted when they are interpolated
}

void FrameTracer::trace_part(const FrameContext& frame, const PixelBox& box, int n, std::size_t slot,
                             VisibilityTile* seen, GlossyBuffer::Part* glossy, TileStats& stats,
                             RadianceImage& radiance) {
    const auto count = static_cast<std::size_t>((box.x1 - box.x0) * (box.y1 - box.y0));
    const std::span<Spectrum> pixels(tile_pixels_[slot].data(), count);
    std::fill(pixels.begin(), pixels.end(), Spectrum{});
    Tile tile{frame, box, n, pixels, stats, clusters_[slot]};
    tile.scattered = quality().scatters_rays();
    tile.seen = seen, tile.glossy = glossy, tile.glossy_frame = &glossy_;
    if (seen) tile.penumbra = &penumbrae_[slot];
    if (frame.ground && frame.ground_step_px == 1) tile.ground = ground_at(frame, box, slot);
    if (moments_) {
        tile.moment_responses = moments_->responses();
        tile.moments = std::span(tile_moments_[slot])
                           .first(count * SubpixelLight::kDifferences * tile.moment_responses.size());
        std::fill(tile.moments.begin(), tile.moments.end(), 0.0f);
        tile.kinds = std::span(tile_kinds_[slot]).first(count);
        std::fill(tile.kinds.begin(), tile.kinds.end(), SubpixelKind::kSmooth);
    }
    const float share = 1 / static_cast<float>(n * n);
    TileParts parts{box, {}, record_, share};
    if (parts_) {
        parts.sums = std::span(parts_->tile_sums[slot]).first(count * kImageParts);
        std::fill(parts.sums.begin(), parts.sums.end(), Spectrum{});
        tile.parts = &parts;
    }
    if (!tile.ground || !add_ground_light(tile)) paths()[slot]->trace(tile);
    if (glossy) glossy_.link(*glossy);
    if (parts_) leave_out_not_finite(pixels, parts), write_parts(parts, share);
    leave_out_not_finite(tile);
    write(pixels, share, box, radiance);
    // A block of several tiles has one mark.
    const bool alone = box.x1 - box.x0 == RadianceImage::kBlock_px;
    if (moments_ && write(tile, share, alone, *moments_)) moments_->mark_unknown(box.x0, box.y0, false);
}

// The pixels of one tile.
void FrameTracer::add_glossy_of(const FrameContext& frame, const GlossyBuffer::Part& part, std::size_t slot,
                                TileStats& stats, RadianceImage& radiance) {
    const PixelBox& box = part.box();
    const int width = box.x1 - box.x0;
    const auto count = static_cast<std::size_t>(width * (box.y1 - box.y0));
    const std::span<Spectrum> pixels(tile_pixels_[slot].data(), count);
    std::fill(pixels.begin(), pixels.end(), Spectrum{});
    Tile tile{frame, box, 1, pixels, stats, clusters_[slot]};
    if (moments_) {
        tile.moment_responses = moments_->responses();
        tile.moments = std::span(tile_moments_[slot])
                           .first(count * SubpixelLight::kDifferences * tile.moment_responses.size());
        std::fill(tile.moments.begin(), tile.moments.end(), 0.0f);
    }
    const float share = part.share();
    TileParts parts{box, {}, record_, share};
    if (parts_) {
        parts.sums = std::span(parts_->tile_sums[slot]).first(count * kImageParts);
        std::fill(parts.sums.begin(), parts.sums.end(), Spectrum{});
        tile.parts = &parts;
    }
    for (const GlossyPoint& point : part.points()) {
        const int x = box.x0 + static_cast<int>(point.pixel) % width,
                  y = box.y0 + static_cast<int>(point.pixel) / width;
        const GlossyLight light = reused_light(glossy_, point, x, y);
        // The surface that has sent it matters only if pictures are taken apart.
        if (!parts_) {
            tile.add(point.pixel, LightPart::kGlossyRays, point.moments, light.surfaces);
            tile.add(point.pixel, LightPart::kPlanetshine, point.moments, light.bodies);
            continue;
        }
        const ShadingPoint at = shading_point_of(point);
        tile.add(at, LightPart::kGlossyRays, light.surfaces);
        tile.add(at, LightPart::kPlanetshine, light.bodies);
    }
    if (parts_) leave_out_not_finite(pixels, parts);
    leave_out_not_finite(tile);
    for (const LightPart of : {LightPart::kGlossyRays, LightPart::kPlanetshine})
        if (parts_ && parts_->parts.has(of)) put_pixels(parts.of(of), share, box, parts_->parts.of(of), kAdd);
    put_pixels(pixels, share, box, radiance, kAdd);
    if (moments_) put_differences(tile, share, *moments_, kAdd);
}

void FrameTracer::write_parts(const TileParts& tile, float share) const {
    for (std::size_t i = 0; i < kImageParts; ++i) {
        const auto part = static_cast<LightPart>(i);
        if (parts_->parts.has(part)) write(tile.of(part), share, tile.box, parts_->parts.of(part));
    }
}

}  // namespace hilcam
