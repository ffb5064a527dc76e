#include "render/frame/object_impostor.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_tracer.h"

namespace hilcam {
namespace {

constexpr PixelSamples kSamples(8);

ImageGeometry buffer_geometry() {
    ImageGeometry geometry;
    geometry.width_px = geometry.height_px = kSamples.buffer_px() * kPicture_px;
    return geometry;
}

}  // namespace

ObjectImpostor::ObjectImpostor(const FrameContext& frame, const VisibilityBuffer::Capacity& capacity)
    : camera_(frame, kPicture_px),
      buffer_(buffer_geometry(), capacity),
      picture_(static_cast<std::size_t>(kPicture_px) * kPicture_px) {
    for (int slot = 0; slot < tbb::this_task_arena::max_concurrency(); ++slot)
        slots_.push_back(std::make_unique<Slot>());
    camera_.view().visibility = &buffer_;
    camera_.view().samples = kSamples;
}

bool ObjectImpostor::look(const FrameSetup& setup, std::size_t i, const FrameTracer& tracer,
                          Glimpse* glimpses, std::size_t& count, TileStats& stats) {
    const ObjectPlan& plan = setup.plan(i);
    camera_.aim(setup.world(), i, plan.distance_m, setup.radius_m(i), kPicture_px, plan.picture_px);
    buffer_.set_focal_length(kSamples.buffer_px() * camera_.view().geometry.focal_length_px);
    const VisibilityBuffer::Shown shown = setup.shown(i);
    const bool fits = buffer_.place(camera_.camera(), {&shown, 1});
    if (fits) {
        for (const auto& slot : slots_) slot->stats = {};
        std::fill(picture_.begin(), picture_.end(), Spectrum{});
        const int edge = tile_edge_px(1), across = kPicture_px / edge;
        tbb::parallel_for(0, across * across, [&](int tile) {
            const int x = tile % across * edge, y = tile / across * edge;
            const auto slot = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
            trace_tile({x, y, x + edge, y + edge}, *slots_[slot], tracer.paths(slot));
        });
        for (const auto& slot : slots_) stats += slot->stats;
        count =
            camera_.find_glimpses(picture_, plan.picture_px, ImpostorCamera::cells_across(plan), glimpses);
    }
    camera_.look_away(i);
    return fits;
}

void ObjectImpostor::trace_tile(const PixelBox& box, Slot& slot, PathModel& paths) {
    if (!camera_.view().object_mask->any(box)) return;
    const int width = box.x1 - box.x0;
    const std::span<Spectrum> pixels(slot.tile.data(), static_cast<std::size_t>(width * (box.y1 - box.y0)));
    std::fill(pixels.begin(), pixels.end(), Spectrum{});
    Tile tile{camera_.view(), box, kVisibilitySamplesAcross, pixels, slot.stats, slot.clusters};
    tile.seen = &slot.seen, tile.penumbra = &slot.penumbra;
    paths.trace(tile);
    slot.stats.covered_px = 0;  // those are not the camera's pixels
    constexpr float kShare = 1.0f / kVisibilitySamples;
    for (int y = box.y0; y < box.y1; ++y)
        for (int x = box.x0; x < box.x1; ++x)
            picture_[static_cast<std::size_t>(y * kPicture_px + x)] =
                kShare * pixels[static_cast<std::size_t>((y - box.y0) * width + x - box.x0)];
}

}  // namespace hilcam
