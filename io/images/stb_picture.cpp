#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "io/images/stb_picture.h"

namespace hilcam {
namespace {

struct Free {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

Texture decode_by_stb(PictureBytes bytes) {
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
    const std::unique_ptr<stbi_uc, Free> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 3));
    if (!pixels) throw refuse();
    if (width != texture.width || height != texture.height) throw undecodable("stb_image: two sizes");
    const std::span<std::uint8_t> out = bytes_of(texture);
    std::copy_n(pixels.get(), out.size(), out.data());
    return texture;
}

}  // namespace hilcam
