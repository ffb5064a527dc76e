#pragma once
// Everything that the models share which trace a tile: the frame, the tile's pixels, counters, random
// numbers.

#include <array>
#include <cstdint>
#include <span>

#include "render/glossy/glossy_buffer.h"
#include "render/shading/frame_context.h"
#include "render/shading/normal_clusters.h"
#include "render/shading/shading_point.h"
#include "render/shading/tile_parts.h"
#include "render/visibility/visibility_tile.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/ray_counts.h"
#include "render/vocabulary/subpixel_light.h"

namespace hilcam {

class PenumbraSampler;

struct TileStats : RayCounts {
    double covered_px = 0;         // by objects
    std::uint64_t not_finite = 0;  // pixels and points whose light was no number, and was left out

    TileStats& operator+=(const TileStats& other) {
        RayCounts::operator+=(other);
        covered_px += other.covered_px;
        not_finite += other.not_finite;
        return *this;
    }
};

struct Tile {
    const FrameContext& frame;
    PixelBox box;
    int samples_per_axis;        // n: an n x n grid of rays in each pixel
    std::span<Spectrum> pixels;  // sums of radiance over a pixel's rays, row by row
    TileStats& stats;
    NormalClusters& clusters;  // clusters of what is seen
    // Rays go through places of a sequence in each pixel (place_sequence.h); false: through a regular grid.
    bool scattered = false;
    VisibilityTile* seen = nullptr;  // for what the visibility buffer finds; null: rays do
    const VisibilityTile* ground =
        nullptr;                          // for what the frame's buffer of the ground finds; null: likewise
    PenumbraSampler* penumbra = nullptr;  // where that is so, to find shadows' edges; null: they are hard

    // Charge rates by channel, difference and pixel (subpixel_light.h), and what makes them of radiance; empty: nobody
    // asks where in its pixel light falls.
    std::span<float> moments{};
    std::span<const Spectrum> moment_responses{};
    std::span<SubpixelKind> kinds{};  // by pixel; likewise

    GlossyBuffer::Part* glossy =
        nullptr;  // gets the lobes that rays are to follow; null: the cache alone has their light
    const TileParts* parts = nullptr;  // for the parts of the light; null: nobody asks

    // Adds light that a shading point sends, to its pixel or to the lobe whose rays have met it: radiance, times the samples for
    // which it stands. part: of light that the camera sees there; what a ray has met is of the ray's part.
    void add(const ShadingPoint& at, LightPart part, const Spectrum& light) {
        add(at, part, at.moments, light);
    }
    void add(const ShadingPoint& at, LightPart part, const SubpixelMoments& shares, const Spectrum& light) {
        if (parts) note(at, part, light);
        if (at.glossy_ray) {
            at.glossy_ray->light += light;
            return;
        }
        add(at.pixel, shares, light);
    }
    // Counts light that was added as one part as another.
    void move(const ShadingPoint& at, LightPart from, LightPart to, const Spectrum& light) const {
        if (parts) note_move(at, from, to, light);
    }
    // Notes light that somebody adds to a pixel by himself, where parts are asked for.
    void note(std::uint32_t pixel, LightPart part, const Spectrum& light) const;
    // Adds light that no shading point sends.
    void add(std::uint32_t pixel, LightPart part, const SubpixelMoments& shares, const Spectrum& light) {
        if (parts) note(pixel, part, light);
        add(pixel, shares, light);
    }
    void set_kind(std::uint32_t pixel, SubpixelKind kind) {
        if (!kinds.empty() && kinds[pixel] != SubpixelKind::kObject) kinds[pixel] = kind;
    }
    std::uint32_t frame_pixel(int x, int y) const {
        return static_cast<std::uint32_t>(y * frame.geometry.padded_width() + x);
    }
    // Random words of a shading point; `use` (below 16) tells apart what they are for.
    std::array<std::uint32_t, 4> random_of(const ShadingPoint& at, std::uint32_t use) const {
        const int width = box.x1 - box.x0;
        const int px = box.x0 + static_cast<int>(at.pixel) % width;
        const int py = box.y0 + static_cast<int>(at.pixel) / width;
        return random_words(frame.key, RandomPurpose::kPathSample, frame_pixel(px, py),
                            (std::uint32_t{at.sample} * 64 + at.depth) * 16 + use);
    }

  private:
    void add(std::uint32_t pixel, const SubpixelMoments& shares, const Spectrum& light) {
        pixels[pixel] += light;
        if (!moments.empty()) add_moments(pixel, shares, light);
    }
    void note(const ShadingPoint& at, LightPart part, const Spectrum& light) const;
    void note_move(const ShadingPoint& at, LightPart from, LightPart to, const Spectrum& light) const;
    void add_moments(std::uint32_t pixel, const SubpixelMoments& shares, const Spectrum& light) {
        float* at = moments.data() + pixel;
        for (const Spectrum& response : moment_responses) {
            const float rate_e_s = sum_of_products(response, light);
            for (const float share : {shares.across, shares.down, shares.crossed}) {
                *at += share * rate_e_s;
                at += pixels.size();
            }
        }
    }
};

}  // namespace hilcam
