#pragma once
// Maps of the Earth in hilcam's own packed form, as tools/make_earth_map.py writes them (docs/earth.md).
//
// Little-endian: "HILEARTH"; version 1, width, height, side of a tile, channels (8) as 32-bit numbers; the length of each
// tile's stream, rows of tiles from the north; the streams. A stream is zlib's (RFC 1950) of a tile's channels one
// after the other, each value less what its neighbours predict: the middle one of left, above, left + above - corner.

#include <filesystem>
#include <span>

#include "render/earth/earth_map.h"

namespace hilcam {

// Throws InputError, one line that names the file: what is wrong, found, accepted.
EarthMap read_earth_map(const std::filesystem::path& file);
// The same from bytes; name begins the message.
EarthMap decode_earth_map(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace hilcam
