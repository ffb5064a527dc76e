#pragma once
// Everything that models share which trace a tile: the frame, the tile's pixels, counters, random numbers.

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
#include "render/vocabulary/units.h"

namespace hilcam {

class PenumbraSampler;

struct TileStats : RayCounts {
    double covered_px = 0;         // by objects
    std::uint64_t not_finite = 0;  // pixels and points whose light was not finite and was dropped

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
    std::span<Spectrum> pixels;  // sums of radiance over a pixel's samples, row by row
    TileStats& stats;
    NormalClusters& clusters;  // memory for normal clusters
    // Rays go through the places of a sequence in each pixel (place_sequence.h); false: through a regular
    // grid.
    bool scattered = false;
    VisibilityTile* seen = nullptr;  // memory for what the visibility buffer finds; null: rays find it
    const VisibilityTile* ground = nullptr;  // results of the frame's ground buffer; null: rays find it
    // Finds penumbrae if the visibility buffer is used; null: shadows have hard edges.
    PenumbraSampler* penumbra = nullptr;

    // Sub-pixel moments as charge rates by channel, difference and pixel (subpixel_light.h), and the
    // responses that make them of radiance; empty: moments are not kept.
    std::span<float> moments{};
    std::span<const Spectrum> moment_responses{};
    std::span<SubpixelKind> kinds{};  // by pixel; empty like moments

    GlossyBuffer::Part* glossy =
        nullptr;  // takes the lobes that get rays; null: their light comes from the cache alone
    GlossyBuffer* glossy_frame = nullptr;  // contains `glossy`
    const TileParts* parts = nullptr;      // takes the parts of the light; null: parts are not kept

    // Adds light that a shading point sends to its pixel, or to the lobe whose ray has met it: radiance,
    // times the number of samples that the point represents. part: used if the camera sees the point; light
    // behind a ray belongs to the ray's part.
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
    // Counts light that was added as one part as another part.
    void move(const ShadingPoint& at, LightPart from, LightPart to, const Spectrum& light) const {
        if (parts) note_move(at, from, to, light);
    }
    // Records light that the caller adds to a pixel itself, if parts are kept.
    void note(std::uint32_t pixel, LightPart part, const Spectrum& light) const;
    // Adds light that does not come from a shading point.
    void add(std::uint32_t pixel, LightPart part, const SubpixelMoments& shares, const Spectrum& light) {
        if (parts) note(pixel, part, light);
        add(pixel, shares, light);
    }
    void set_kind(std::uint32_t pixel, SubpixelKind kind) {
        if (!kinds.empty() && kinds[pixel] != SubpixelKind::kObject) kinds[pixel] = kind;
    }
    // Returns the light of a pixel of white paint under an irradiance: radiance times samples, largest bin.
    float white_paint(const Spectrum& irradiance_w_m2_um) const {
        return static_cast<float>(samples_per_axis * samples_per_axis) * max_component(irradiance_w_m2_um) /
               kPiF;
    }
    std::uint32_t frame_pixel(int x, int y) const {
        return static_cast<std::uint32_t>(y * frame.geometry.padded_width() + x);
    }
    // Returns random words for a shading point; `use` (below 16) distinguishes their purposes.
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
