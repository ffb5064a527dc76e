#pragma once
// Reads pictures from users: textures, maps of bodies, maps of a detector. PNG, JPEG, TIFF, BMP, WebP, PPM,
// PGM, TGA.
//
// A picture's size is read from its header and bounded before anything is decoded. Files are decoded in a
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

// Returns the limits with which picture files are opened.
const InputKind& picture_kind();

// Reads an 8-bit colour picture as a texture. Throws InputError when it is too large or does not decode.
Texture read_picture(const std::filesystem::path& file);
// Reads one number a pixel: TIFF of one channel (integers of 8 to 32 bits, floats), PNG or PGM of one channel
// (8 or 16 bits), or FITS. Throws InputError when the file is missing, is too large, does not decode, has
// several channels, or has a value that is not a number or, unless any_sign, negative.
PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign);

// Decodes in this process, for callers that run in a child already. what: begins messages. The texture has no
// name.
Texture decode_texture(std::span<const std::uint8_t> bytes, const std::string& what);
// Returns the alpha channel of such a picture, one byte a pixel; empty when it has none. Only PNG and WebP
// can have one.
std::vector<std::uint8_t> decode_alpha(std::span<const std::uint8_t> bytes, const std::string& what);
// Decodes a map of numbers, of any sign, finite or not. Throws PictureFault (picture_codecs.h).
PixelMap decode_numbers(std::span<const std::uint8_t> bytes);

}  // namespace hilcam
