#pragma once
// The light in a tile's pixels by parts, for pictures that are taken apart. Frames of the loop have none.

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/shading/pixel_record.h"
#include "render/vocabulary/light_part.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct TileParts {
    PixelBox box;                   // the tile
    std::span<Spectrum> sums;       // by part (kImageParts), then by pixel
    PixelRecord* record = nullptr;  // record of some pixels, possibly outside this tile; null: none
    float share = 1;                // factor that turns sums into radiance

    std::size_t pixels() const { return sums.size() / kImageParts; }
    std::span<Spectrum> of(LightPart part) const {
        return sums.subspan(static_cast<std::size_t>(part) * pixels(), pixels());
    }
    void add(std::uint32_t pixel, LightPart part, const Spectrum& light) const { of(part)[pixel] += light; }
    // Moves light of a pixel from one part to another.
    void move(std::uint32_t pixel, LightPart from, LightPart to, const Spectrum& light) const {
        of(from)[pixel] += -1.0f * light, of(to)[pixel] += light;
    }
    bool is_recorded(std::uint32_t pixel) const {
        if (!record) return false;
        const int width = box.x1 - box.x0;
        return record->holds(box.x0 + static_cast<int>(pixel) % width,
                             box.y0 + static_cast<int>(pixel) / width);
    }
};

}  // namespace hilcam
