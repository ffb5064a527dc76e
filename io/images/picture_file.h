#pragma once
// Pictures from outside: textures, maps of bodies, maps of a detector. PNG, JPEG, TIFF, BMP, WebP, PPM, PGM, TGA.
//
// A picture's size is read from its header before anything is decoded, and bounded; files are decoded in a
// child process with limits (confined.h).

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/system/input_file.h"
#include "render/vocabulary/mesh.h"
#include "sensor/fixed_pattern.h"

namespace hilcam {

// The kind as which picture files are opened.
const InputKind& picture_kind();

// An 8-bit colour picture as a texture. InputError when it is too large or does not decode.
Texture read_picture(const std::filesystem::path& file);
// A number for each pixel: TIFF of one channel (whole numbers of 8 to 32 bits, floats), PNG or PGM of one channel
// (8 or 16 bits), or FITS. InputError when it is missing, too large, does not decode, has several channels or a value
// that is negative (unless any_sign) or not a number.
PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign);

// Decodes here, without a child of its own: for what runs in one. `what` begins messages. The texture has no
// name.
Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what);
// The alpha channel of such a picture, a byte for each of its pixels; empty where it has none: PNG and WebP have them.
std::vector<std::uint8_t> decode_alpha(std::span<const std::uint8_t> bytes, const std::string& what);
// The same of a map of numbers, of any sign and finite or not. PictureFault of picture_codecs.h.
PixelMap decode_numbers(std::span<const std::uint8_t> bytes);

}  // namespace hilcam
