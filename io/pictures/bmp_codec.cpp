#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "io/pictures/picture_codecs.h"

namespace hilcam {
namespace {

struct Free {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

std::uint64_t number_at(PictureBytes bytes, std::size_t at, std::size_t size) {
    std::uint64_t out = 0;
    for (std::size_t i = size; i-- > 0;) out = out << 8 | bytes[at + i];
    return out;
}

// Returns how many bytes a picture without compression has, by its header (Microsoft, BITMAPFILEHEADER, BITMAPINFOHEADER and
// BITMAPCOREHEADER): rows end on four bytes.
std::uint64_t size_by_header(PictureBytes bytes, int width, int height) {
    constexpr std::size_t kOldHeader_bytes = 12;
    const std::uint64_t bits = number_at(bytes, number_at(bytes, 14, 4) == kOldHeader_bytes ? 24 : 28, 2);
    const std::uint64_t row_bytes = (static_cast<std::uint64_t>(width) * bits + 31) / 32 * 4;
    return number_at(bytes, 10, 4) + row_bytes * static_cast<std::uint64_t>(height);
}

}  // namespace

Texture decode_bmp(PictureBytes bytes) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw undecodable("stb_image: the file is too large");
    const auto size = static_cast<int>(bytes.size());
    const auto refuse = [] {
        const char* const why = stbi_failure_reason();
        return undecodable(std::string("stb_image: ") + (why ? why : "no reason given"));
    };
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) throw refuse();
    Texture texture = blank_texture(static_cast<std::uint64_t>(std::max(width, 0)),
                                    static_cast<std::uint64_t>(std::max(height, 0)));
    // Newer versions of the library take what is missing for black.
    constexpr std::size_t kLeastHeader_bytes = 30;
    if (bytes.size() < kLeastHeader_bytes ||
        bytes.size() < size_by_header(bytes, texture.width, texture.height))
        throw undecodable("stb_image: the file ends too early");
    const std::unique_ptr<stbi_uc, Free> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3));
    if (!pixels) throw refuse();
    if (width != texture.width || height != texture.height) throw undecodable("stb_image: two sizes");
    const std::span<std::uint8_t> out = bytes_of(texture);
    std::copy_n(pixels.get(), out.size(), out.data());
    return texture;
}

}  // namespace hilcam
