#pragma once
// What the models that trace a tile share: the frame, the tile's pixels, counters, random numbers.

#include <array>
#include <cstdint>
#include <span>

#include "render/frame_view.h"
#include "render/path_vertex.h"
#include "render/pixel_box.h"

namespace hilcam {

struct TileStats {
    std::uint64_t primary_rays = 0, shadow_rays = 0, secondary_rays = 0;
    double covered_px = 0;  // by objects

    TileStats& operator+=(const TileStats& other) {
        primary_rays += other.primary_rays, shadow_rays += other.shadow_rays;
        secondary_rays += other.secondary_rays, covered_px += other.covered_px;
        return *this;
    }
};

struct Tile {
    const FrameView& frame;
    PixelBox box;
    int samples_per_axis;        // n: an n x n grid of rays in each pixel
    std::span<Spectrum> pixels;  // sums of radiance over a pixel's rays, row by row
    TileStats& stats;

    // Random words of a path's vertex; `use` (below 16) tells apart what they are for.
    std::array<std::uint32_t, 4> random_of(const Vertex& at, std::uint32_t use) const {
        const int width = box.x1 - box.x0;
        const int px = box.x0 + static_cast<int>(at.pixel) % width;
        const int py = box.y0 + static_cast<int>(at.pixel) / width;
        return random_words(frame.key, RandomPurpose::kPathSample,
                            static_cast<std::uint32_t>(py * frame.geometry.padded_width() + px),
                            (std::uint32_t{at.sample} * 64 + at.depth) * 16 + use);
    }
};

}  // namespace hilcam
