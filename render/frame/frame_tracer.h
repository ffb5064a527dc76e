#pragma once
// Traces a placed frame tile by tile on oneTBB's threads. Every slot of the thread pool has a path model and
// scratch memory of its own; a tile's result depends neither on the slot nor on the order.
//
// Has several qualities ready (levels), of which one is in use: path models and memory are made for all of
// them beforehand.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/frame/frame_setup.h"
#include "render/frame/parts_buffer.h"
#include "render/frame/render_quality.h"
#include "render/glossy/glossy_buffer.h"
#include "render/ground_shading/ground_upsampler.h"
#include "render/sunlight/penumbra_sampler.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/tile_grid.h"

namespace hilcam {

class FrameTracer {
  public:
    // One path model for each slot.
    using Paths = std::vector<std::unique_ptr<PathModel>>;

    // levels: at least one; the first is in use. Throws InputError when a path model is not known. Owner
    // thread.
    FrameTracer(const ImageGeometry& geometry, const Modules& modules, std::span<const RenderQuality> levels);

    // Takes effect from the next frame on. Loop.
    void use_level(std::size_t level);
    const RenderQuality& quality() const { return levels_[level_].quality; }
    // From the next frame on takes pictures apart, too, and notes what recorded pixels are made of; null: no more.
    // buffer: has the tracer's slots(). Loop, between two frames: nothing is allocated.
    void keep_parts(PartsBuffer* buffer, PixelRecord* record);
    // Any thread.
    std::size_t slots() const { return tile_pixels_.size(); }
    // slot: of the thread pool.
    PathModel& paths(std::size_t slot) const { return *paths()[slot]; }
    static Paths make_paths(const Modules& modules, const std::string& name);
    // Replaces the path models of the level in use, for a comparison (render_bench.h).
    void exchange_paths(Paths& paths) { std::swap(path_sets_[levels_[level_].paths].models, paths); }

    // Share of the present frame's tiles that are done. Any thread.
    double share_done() const;

    // Fills the image. Loop.
    TileStats trace(const FrameSetup& setup, RadianceImage& radiance);

    // Runs work(tile index, tile, slot of the thread) over all tiles.
    template <class Work>
    void for_each_tile(const Work& work) {
        for_each(levels_[level_].tiles, work);
    }

  private:
    struct Level {
        RenderQuality quality;
        std::size_t paths;  // index of its set
        TileGrid tiles;
    };
    struct PathSet {
        std::string name;
        Paths models;
    };
    int width_, height_;
    std::vector<Level> levels_;
    std::size_t level_ = 0;
    std::vector<PathSet> path_sets_;
    SubpixelLight* moments_ = nullptr;  // the present frame's; null: it is made without
    // The pixels of the tile in work, one list per slot.
    std::vector<std::vector<Spectrum>> tile_pixels_;
    std::vector<std::vector<SubpixelKind>> tile_kinds_;  // likewise
    std::vector<std::vector<float>> tile_moments_;       // likewise; none where rays see
    PartsBuffer* parts_ = nullptr;                       // null: nobody asks for them
    PixelRecord* record_ = nullptr;                      // likewise
    std::vector<NormalClusters> clusters_;
    // A tile of the frame's buffer of the ground, of which several of the picture's are parts.
    struct GroundSeen {
        VisibilityTile tile;
        int x_px = -1, y_px = -1;
        bool any = false;
    };
    std::vector<GroundSeen> ground_seen_;     // one per slot; none where rays see
    bool ground_has_steps_ = false;           // at some level
    std::optional<GroundUpsampler> places_;   // none before the first frame, and where no level has them
    std::vector<VisibilityTile> seen_;        // likewise
    std::vector<PenumbraSampler> penumbrae_;  // likewise
    std::vector<TileStats> tile_stats_;       // by tile
    GlossyBuffer glossy_;                     // no parts where no level caches light
    std::atomic<int> tiles_done_{0}, tiles_all_{0};  // tiles of the present frame

    const Paths& paths() const { return path_sets_[levels_[level_].paths].models; }
    std::size_t path_set(const Modules& modules, const std::string& name);
    template <class Work>
    static void for_each(const TileGrid& tiles, const Work& work) {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, tiles.size()), [&](const tbb::blocked_range<int>& range) {
                const auto slot = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
                for (int i = range.begin(); i < range.end(); ++i) work(i, tiles[i], slot);
            });
    }
    TileStats sum_of_stats(int tiles) const;
    void find_moments(const FrameSetup& setup, bool marks, RadianceImage& radiance);
    void trace_tile(const FrameSetup& setup, int index, std::size_t slot, RadianceImage& radiance);
    void add_glossy(const FrameContext& frame, RadianceImage& radiance);
    void add_glossy_of(const FrameContext& frame, const GlossyBuffer::Part& part, std::size_t slot,
                       TileStats& stats, RadianceImage& radiance);
    const VisibilityTile* ground_at(const FrameContext& frame, const PixelBox& box, std::size_t slot);
    TileStats trace_places(const FrameContext& frame, const RadianceImage& radiance);
    void trace_places_of(const FrameContext& frame, const PixelBox& box, std::size_t slot, TileStats& stats);
    void trace_part(const FrameContext& frame, const PixelBox& box, int n, std::size_t slot,
                    VisibilityTile* seen, GlossyBuffer::Part* glossy, TileStats& stats,
                    RadianceImage& radiance);
    void write_parts(const TileParts& tile, float share) const;
};

}  // namespace hilcam
