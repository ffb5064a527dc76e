#pragma once
// glTF's extension EXT_texture_webp, which assimp does not know: the image index moves to where every reader
// looks.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace hilcam {

// A binary glTF whose textures name their WebP images as plain sources; nothing when the bytes are no GLB or
// need no change. Lengths are checked before use.
std::optional<std::vector<std::uint8_t>> with_plain_webp_sources(std::span<const std::uint8_t> glb);

}  // namespace hilcam
