#include "io/images/picture_codecs.h"
#include "io/images/picture_opening.h"
#include "io/images/picture_size.h"
#include "io/images/stb_picture.h"

namespace hilcam {
namespace {

// Returns the size in bytes that the header of an uncompressed picture implies (Microsoft, BITMAPFILEHEADER,
// BITMAPINFOHEADER and BITMAPCOREHEADER); rows are padded to four bytes.
std::uint64_t size_by_header(PictureBytes bytes, const PictureSize& size) {
    constexpr std::uint64_t kOldHeader_bytes = 12;
    const PictureOpening h(bytes);
    const std::uint64_t bits = h.little(h.little(14, 4) == kOldHeader_bytes ? 24 : 28, 2);
    const std::uint64_t row_bytes = (size.width * bits + 31) / 32 * 4;
    return h.little(10, 4) + row_bytes * size.height;
}

}  // namespace

Texture decode_bmp(PictureBytes bytes) {
    constexpr std::size_t kMinHeader_bytes = 30;
    const auto size = picture_size(bytes);
    if (!size) throw undecodable("no head of a BMP");
    require_few_pixels(size->width, size->height);
    if (bytes.size() < kMinHeader_bytes || bytes.size() < size_by_header(bytes, *size))
        throw undecodable("stb_image: the file ends too early");
    return decode_by_stb(bytes);
}

}  // namespace hilcam
