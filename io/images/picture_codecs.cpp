#include "io/images/picture_codecs.h"

#include "io/images/picture_size.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

PictureFault undecodable(const std::string& reason) {
    const std::string why = reason.empty() ? std::string() : " (" + shortened(reason) + ")";
    return PictureFault("does not decode" + why + "; accepted: " + kPictureKinds);
}

void require_few_pixels(std::uint64_t width, std::uint64_t height) {
    if (width == 0 || height == 0) throw undecodable("it has no pixels");
    // Compared by division, because a TIFF may claim 2^64.
    if (width > kMaxPicturePixels / height)
        throw PictureFault("has " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels; accepted: at most " + std::to_string(kMaxPicturePixels) +
                           ", as 16384 x 16384");
}

Texture blank_texture(std::uint64_t width, std::uint64_t height) {
    require_few_pixels(width, height);
    Texture texture{{}, static_cast<int>(width), static_cast<int>(height), {}};
    texture.texels.resize(width * height);
    return texture;
}

std::vector<std::uint8_t> every_fourth(std::span<const std::uint8_t> samples) {
    std::vector<std::uint8_t> out(samples.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = samples[4 * i + 3];
    return out;
}

std::span<std::uint8_t> bytes_of(Texture& texture) {
    static_assert(sizeof(texture.texels[0]) == 3);
    return {reinterpret_cast<std::uint8_t*>(texture.texels.data()), 3 * texture.texels.size()};
}

}  // namespace hilcam
