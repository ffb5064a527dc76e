#pragma once
// Memory for the parts of frames: an image of each part of the light (light_part.h), and sums for the tiles
// in work. The caller that asks for parts makes it, so taking frames apart allocates nothing.

#include <cstddef>
#include <optional>
#include <vector>

#include "render/shading/path_model.h"
#include "render/vocabulary/light_parts.h"

namespace hilcam {

struct PartsBuffer {
    // like: an image like those that frames fill. slots: of the thread pool. only: the one part that is
    // wanted; none: all.
    PartsBuffer(const RadianceImage& like, std::size_t slots, std::optional<LightPart> only = std::nullopt)
        : parts(like, only), tile_sums(slots, std::vector<Spectrum>(PathModel::kMaxSamples * kImageParts)) {}

    LightParts parts;
    std::vector<std::vector<Spectrum>> tile_sums;  // by part, then by pixel of the tile; one list per slot
};

}  // namespace hilcam
