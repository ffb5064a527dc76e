#pragma once
// Decoders and encoders of pictures, one source for each format over that format's library. Sizes are bounded
// before memory is allocated. A library's messages about bad bytes are kept and not printed.
//
//  PNG   libpng         colours as stored (gAMA, iCCP and sRGB are not applied), 16 bits cut to 8
//  JPEG  libjpeg-turbo  grey and colour of 8 bits; the EXIF orientation is not applied
//  TIFF  libtiff        the first page
//  WebP  libwebp        one picture, no animation
//  BMP   stb_image      not run-length encoded
//  FITS  own code       numbers: the first two-axis image, uncompressed
//  PPM   own code       also PGM: bytes or 16-bit words of any depth, cut to 8 bits
//  TGA   stb_image      colour, grey and palettes, also run-length encoded
//
// Only decode_png_alpha() and decode_webp_alpha() read an alpha channel.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "render/vocabulary/mesh.h"
#include "sensor/fixed_pattern.h"

namespace hilcam {

using PictureBytes = std::span<const std::uint8_t>;

inline constexpr const char* kPictureKinds = "PNG, JPEG, TIFF, BMP, WebP, PPM, PGM, TGA";

// The reason why a picture is refused: the rest of a sentence that begins with the picture's name.
class PictureFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};
// Returns "does not decode (libpng: bad CRC); accepted: ..."; reason may be empty.
[[nodiscard]] PictureFault undecodable(const std::string& reason);

// Throws PictureFault when a picture would have no pixels, or more than kMaxPicturePixels.
void require_few_pixels(std::uint64_t width, std::uint64_t height);
// Returns a black texture of that size, after require_few_pixels().
Texture blank_texture(std::uint64_t width, std::uint64_t height);
// Returns a texture's memory as bytes: red, green, blue.
std::span<std::uint8_t> bytes_of(Texture& texture);
// Returns every fourth sample, from the fourth on: the alpha of RGBA pixels.
std::vector<std::uint8_t> every_fourth(std::span<const std::uint8_t> samples);

// Decode a colour picture. All throw PictureFault. Any thread.
Texture decode_png(PictureBytes bytes);
Texture decode_jpeg(PictureBytes bytes);
Texture decode_tiff(PictureBytes bytes);
Texture decode_webp(PictureBytes bytes);
Texture decode_bmp(PictureBytes bytes);
Texture decode_pnm(PictureBytes bytes);
Texture decode_tga(PictureBytes bytes);
// Return the alpha channel, one byte a pixel, rows from the top; 255 where the picture has none.
std::vector<std::uint8_t> decode_png_alpha(PictureBytes bytes);
std::vector<std::uint8_t> decode_webp_alpha(PictureBytes bytes);
// Return one number a pixel from a picture with one channel: PNG and PGM up to 16 bits, TIFF of 8 to 32 bits
// or floats.
PixelMap decode_png_numbers(PictureBytes bytes);
PixelMap decode_tiff_numbers(PictureBytes bytes);
PixelMap decode_pnm_numbers(PictureBytes bytes);

// FITS 4.0 (IAU FITS Working Group, 2018): the primary image, or the first image extension with two axes; 8
// to 32 bits or floats, with BSCALE and BZERO. The value BLANK becomes NaN. Pixel (x, y) is data[y][x], from
// the first row of the file, or from the last with ROWORDER BOTTOM-UP. Own code, because cfitsio as Debian
// and Ubuntu package it would bring network code into the program.
bool is_fits_picture(PictureBytes bytes);
struct FitsSize {
    std::uint64_t width = 0, height = 0;
};
FitsSize fits_picture_size(PictureBytes bytes);
PixelMap decode_fits_numbers(PictureBytes bytes);

enum class SampleKind { kGray8, kGray16, kRgb8 };
// Samples of a picture: rows without padding, 16-bit numbers in the machine's byte order, colours as red,
// green, blue.
struct PictureSamples {
    PictureBytes bytes;
    int width = 0, height = 0;
    SampleKind kind = SampleKind::kGray8;
};

// Notes of a PNG. texts: in order, a keyword of 1 to 79 Latin letters and a UTF-8 text. gamma: of the
// samples, usually 2.2; 0: not written.
struct PngNotes {
    std::vector<std::pair<std::string, std::string>> texts;
    double gamma = 0;
};
// Returns the file's bytes; empty when encoding failed. Any thread.
std::string encode_png(const PictureSamples& picture, const PngNotes& notes = {});

// Notes of a TIFF; empty fields are left out. date_time: "2026:03:20 06:00:00".
struct TiffNotes {
    std::string description, software, model, date_time;
};
std::string encode_tiff(const PictureSamples& picture, const TiffNotes& notes = {});

}  // namespace hilcam
