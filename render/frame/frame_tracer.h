#pragma once
// Traces a placed frame tile by tile on oneTBB's threads. Each slot of the thread pool has its own path model
// and scratch memory; a tile's result depends neither on the slot nor on the order of tiles.
//
// It is ready for several qualities (levels), of which one is in use: path models and memory for all of them
// are made in advance.

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
    // One path model for each slot of the thread pool.
    using Paths = std::vector<std::unique_ptr<PathModel>>;

    // levels: at least one; the first is in use. Throws InputError if a path model is unknown. Owner thread.
    FrameTracer(const ImageGeometry& geometry, const Modules& modules, std::span<const RenderQuality> levels);

    // Takes effect with the next frame. Loop.
    void use_level(std::size_t level);
    const RenderQuality& quality() const { return levels_[level_].quality; }
    // From the next frame on, also stores the parts of the light and the contents of recorded pixels; null
    // stops that. buffer: must have slots() slots. Loop, between two frames: no allocation.
    void keep_parts(PartsBuffer* buffer, PixelRecord* record);
    // Any thread.
    std::size_t slots() const { return tile_pixels_.size(); }
    // slot: number of the slot in the thread pool.
    PathModel& paths(std::size_t slot) const { return *paths()[slot]; }
    static Paths make_paths(const Modules& modules, const std::string& name);
    // Swaps the path models of the level in use, for a comparison (render_bench.h).
    void exchange_paths(Paths& paths) { std::swap(path_sets_[levels_[level_].paths].models, paths); }

    // Returns the share of the present frame's tiles that are done. Any thread.
    double share_done() const;

    // Renders the frame into the image. Loop.
    TileStats trace(const FrameSetup& setup, RadianceImage& radiance);

    // Calls work(tile index, tile, slot of the thread) for all tiles.
    template <class Work>
    void for_each_tile(const Work& work) {
        for_each(levels_[level_].tiles, work);
    }

  private:
    struct Level {
        RenderQuality quality;
        std::size_t paths;  // index into path_sets_
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
    SubpixelLight* moments_ = nullptr;  // the present frame's; null: it has no moments
    // Pixels of the tile that a slot works on.
    std::vector<std::vector<Spectrum>> tile_pixels_;
    std::vector<std::vector<SubpixelKind>> tile_kinds_;  // sub-pixel kinds of the same pixels
    std::vector<std::vector<float>> tile_moments_;       // sub-pixel moments; empty if rays find visibility
    PartsBuffer* parts_ = nullptr;                       // null: parts are not stored
    PixelRecord* record_ = nullptr;                      // null: no pixels are recorded
    std::vector<NormalClusters> clusters_;
    // A tile of the ground's visibility buffer, which covers several tiles of the picture.
    struct GroundSeen {
        VisibilityTile tile;
        int x_px = -1, y_px = -1;
        bool any = false;
    };
    std::vector<GroundSeen> ground_seen_;    // one per slot; empty if rays find visibility
    bool ground_has_steps_ = false;          // true at some level
    std::optional<GroundUpsampler> places_;  // empty before the first frame, and if no level has ground steps
    std::vector<VisibilityTile> seen_;       // one per slot
    std::vector<PenumbraSampler> penumbrae_;         // one per slot
    std::vector<TileStats> tile_stats_;              // one per tile
    GlossyBuffer glossy_;                            // no parts if no level caches light
    std::atomic<int> tiles_done_{0}, tiles_all_{0};  // number of tiles of the present frame

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
