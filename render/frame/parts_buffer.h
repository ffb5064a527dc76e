#pragma once
// The memory into which frames are taken apart: an image of each part of their light (light_part.h), and the sums of the tiles in work.
// Who asks for parts makes it, so that frames that are taken apart allocate no more than others.

#include <cstddef>
#include <optional>
#include <vector>

#include "render/shading/path_model.h"
#include "render/vocabulary/light_parts.h"

namespace hilcam {

struct PartsBuffer {
    // like: an image like those that frames fill. slots: of the thread pool. only: the one part that is wanted; none: all are.
    PartsBuffer(const RadianceImage& like, std::size_t slots, std::optional<LightPart> only = std::nullopt)
        : parts(like, only), tile_sums(slots, std::vector<Spectrum>(PathModel::kMaxSamples * kImageParts)) {}

    LightParts parts;
    std::vector<std::vector<Spectrum>> tile_sums;  // by part, then by pixel of the tile; a list per slot
};

}  // namespace hilcam
