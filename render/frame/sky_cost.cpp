#include "render/frame/sky_cost.h"

#include <algorithm>
#include <array>
#include <memory>

#include "render/light/primary_vertices.h"
#include "render/light/tile.h"
#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {

std::vector<double> sky_costs_ms(const FrameView& frame) {
    if (!frame.rays->linear()) return {};
    constexpr int kTile_px = 32, kTimes = 3;
    constexpr double kLong_ms = 200;  // long enough to be measured once
    constexpr std::size_t kPixels = kTile_px * kTile_px;
    const auto facets = std::make_unique<FacetList>();
    std::vector<Spectrum> pixels(kPixels);
    std::vector<std::uint8_t> uncovered(kPixels, static_cast<std::uint8_t>(kVisibilitySamples));
    const int width = frame.geometry.padded_width(), height = frame.geometry.padded_height();
    const int across = (width + kTile_px - 1) / kTile_px,
              count = across * ((height + kTile_px - 1) / kTile_px);
    // A thousand tiles tell.
    const int stride = 1 + count / 1024;
    std::vector<double> out;
    for (std::size_t body = 0; body < frame.body_box_count; ++body) {
        double least_ms = 0;
        for (int time = 0; time < kTimes && least_ms < kLong_ms; ++time) {
            const Stopwatch watch;
            for (int i = 0; i < count; i += stride) {
                const int x = i % across * kTile_px, y = i / across * kTile_px;
                const PixelBox box{x, y, std::min(x + kTile_px, width), std::min(y + kTile_px, height)};
                if (!box.overlaps(frame.body_boxes[body])) continue;
                TileStats stats;
                Tile tile{frame, box, kVisibilitySamplesAcross, pixels, stats, *facets};
                add_backdrop(tile, uncovered.data());
            }
            const double ms = stride * watch.ms();
            least_ms = time == 0 ? ms : std::min(least_ms, ms);
        }
        out.push_back(least_ms);
    }
    return out;
}

}  // namespace hilcam
