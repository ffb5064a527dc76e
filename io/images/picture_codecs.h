#pragma once
// Pictures and their bytes: one source for each kind, over the library that the kind has. Sizes are bounded
// before memory is taken; what a library says of bytes that it cannot decode is kept and not printed.
//
//   PNG   libpng         colours as they are stored (gAMA, iCCP and sRGB are not applied), 16 bits cut to 8
//   JPEG  libjpeg-turbo  grey and colour of 8 bits; its EXIF orientation is not applied
//   TIFF  libtiff        the first page
//   WebP  libwebp        one picture, no animation
//   BMP   stb_image      without run lengths
//   FITS  this program   numbers: the first image of two axes, not compressed
//   PPM   own            and PGM: in bytes or words, of any depth to 16 bits, cut to 8
//   TGA   stb_image      colours, grey and palettes, also by run lengths
//
// An alpha channel is left out, but for decode_png_alpha() and decode_webp_alpha().

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

// Why a picture is not taken: the rest of a sentence that begins with its name.
class PictureFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};
// "does not decode (libpng: bad CRC); accepted: ..."; reason may be empty.
[[nodiscard]] PictureFault undecodable(const std::string& reason);

// PictureFault when a picture would have more than kMaxPicturePixels pixels, or none.
void require_few_pixels(std::uint64_t width, std::uint64_t height);
// A black texture of that size, which is required to be one of few pixels.
Texture blank_texture(std::uint64_t width, std::uint64_t height);
// Its memory as bytes: red, green, blue.
std::span<std::uint8_t> bytes_of(Texture& texture);
// The last of each four samples: alpha beside red, green and blue.
std::vector<std::uint8_t> every_fourth(std::span<const std::uint8_t> samples);

// All throw PictureFault. Any thread.
Texture decode_png(PictureBytes bytes);
Texture decode_jpeg(PictureBytes bytes);
Texture decode_tiff(PictureBytes bytes);
Texture decode_webp(PictureBytes bytes);
Texture decode_bmp(PictureBytes bytes);
Texture decode_pnm(PictureBytes bytes);
Texture decode_tga(PictureBytes bytes);
// The alpha channel alone, a byte for each pixel, rows from the top; 255 where a picture has none.
std::vector<std::uint8_t> decode_png_alpha(PictureBytes bytes);
std::vector<std::uint8_t> decode_webp_alpha(PictureBytes bytes);
// A number for each pixel, of pictures of one channel: PNG and PGM to 16 bits, TIFF of 8 to 32 bits or of floats.
PixelMap decode_png_numbers(PictureBytes bytes);
PixelMap decode_tiff_numbers(PictureBytes bytes);
PixelMap decode_pnm_numbers(PictureBytes bytes);

// FITS 4.0 (IAU FITS Working Group, 2018): the primary image, or the first extension that is an image of two axes; 8 to 32 bits or
// floats, with BSCALE and BZERO. The value BLANK is NaN. Pixel (x, y) is data[y][x], the first row of the file; with ROWORDER BOTTOM-UP the
// last. Library-free: the one that both Debians package, cfitsio, brings network code into the program.
bool is_fits_picture(PictureBytes bytes);
struct FitsSize {
    std::uint64_t width = 0, height = 0;
};
FitsSize fits_picture_size(PictureBytes bytes);
PixelMap decode_fits_numbers(PictureBytes bytes);

enum class SampleKind { kGray8, kGray16, kRgb8 };
// Rows without padding; 16-bit numbers as the machine has them, colours as red, green, blue.
struct PictureSamples {
    PictureBytes bytes;
    int width = 0, height = 0;
    SampleKind kind = SampleKind::kGray8;
};

// Texts of a PNG in their order: a keyword of 1 to 79 Latin letters, and UTF-8. gamma: of the samples, 2.2 as
// a rule; 0: unsaid.
struct PngNotes {
    std::vector<std::pair<std::string, std::string>> texts;
    double gamma = 0;
};
// Empty when it cannot be made. Any thread.
std::string encode_png(const PictureSamples& picture, const PngNotes& notes = {});

// Empty fields are left out. date_time: "2026:03:20 06:00:00".
struct TiffNotes {
    std::string description, software, model, date_time;
};
std::string encode_tiff(const PictureSamples& picture, const TiffNotes& notes = {});

}  // namespace hilcam
