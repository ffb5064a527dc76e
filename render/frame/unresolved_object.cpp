#include "render/frame/unresolved_object.h"

#include <algorithm>

namespace hilcam {

UnresolvedObject::UnresolvedObject(const FrameContext& frame, int max_samples)
    : camera_(frame, max_samples),
      tile_(PathModel::kMaxSamples),
      picture_(static_cast<std::size_t>(max_samples * max_samples)) {}

TileStats UnresolvedObject::trace(int samples, PathModel& paths) {
    const int edge = tile_edge_px(1);
    TileStats stats;
    for (int y = 0; y < samples; y += edge)
        for (int x = 0; x < samples; x += edge) {
            const PixelBox box{x, y, std::min(x + edge, samples), std::min(y + edge, samples)};
            const int width = box.x1 - box.x0;
            const std::span<Spectrum> pixels(tile_.data(),
                                             static_cast<std::size_t>(width * (box.y1 - box.y0)));
            std::fill(pixels.begin(), pixels.end(), Spectrum{});
            Tile tile{camera_.view(), box, 1, pixels, stats, *clusters_};
            paths.trace(tile);
            for (int row = box.y0; row < box.y1; ++row)
                std::copy_n(pixels.begin() + (row - box.y0) * width, width,
                            picture_.begin() + row * samples + box.x0);
        }
    stats.covered_px = 0;  // those are not the camera's pixels
    return stats;
}

std::size_t UnresolvedObject::look(const WorldSnapshot& world, std::size_t i, const ObjectPlan& plan,
                                   double radius_m, PathModel& paths, Glimpse* glimpses, TileStats& stats) {
    const int samples = plan.point_samples;
    camera_.aim(world, i, plan.distance_m, radius_m, samples, samples);
    stats += trace(samples, paths);
    camera_.look_away(i);
    return camera_.find_glimpses(picture_, samples, std::min(ImpostorCamera::cells_across(plan), samples),
                                 glimpses);
}

}  // namespace hilcam
