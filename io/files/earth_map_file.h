#pragma once
// Reads maps of the Earth in hilcam's packed form, which tools/make_earth_map.py writes (docs/earth.md).
//
// Little-endian: "HILEARTH"; then 32-bit numbers: version 1, width, height, side of a tile, channels (8), and
// the length of each tile's stream, by rows of tiles from the north; then the streams. A stream is zlib's
// (RFC 1950) and holds the channels of a tile one after the other. Each value is stored as its difference
// from the prediction: the median of left, above, and left + above - corner.

#include <filesystem>
#include <span>

#include "render/earth/earth_map.h"

namespace hilcam {

// Throws InputError, one line that names the file: what is wrong, found, accepted.
EarthMap read_earth_map(const std::filesystem::path& file);
// Decodes the same from memory; name begins messages.
EarthMap decode_earth_map(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace hilcam
