#include <webp/decode.h>

#include <new>

#include "io/pictures/picture_codecs.h"

namespace hilcam {
namespace {

const char* reason_of(VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_NOT_ENOUGH_DATA:
        case VP8_STATUS_SUSPENDED:
            return "libwebp: the file ends too early";
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return "libwebp: it has a feature that is not supported";
        case VP8_STATUS_OK:
        case VP8_STATUS_OUT_OF_MEMORY:
        case VP8_STATUS_INVALID_PARAM:
        case VP8_STATUS_BITSTREAM_ERROR:
        case VP8_STATUS_USER_ABORT:
            break;
    }
    return "libwebp: its bits make no picture";
}

}  // namespace

Texture decode_webp(PictureBytes bytes) {
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) throw undecodable("libwebp: another version of it was expected");
    VP8StatusCode status = WebPGetFeatures(bytes.data(), bytes.size(), &config.input);
    if (status != VP8_STATUS_OK) throw undecodable(reason_of(status));
    if (config.input.has_animation) throw PictureFault("is an animation; accepted: one picture");
    Texture texture = blank_texture(static_cast<std::uint64_t>(config.input.width),
                                    static_cast<std::uint64_t>(config.input.height));
    config.output.colorspace = MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {bytes_of(texture).data(), 3 * texture.width, bytes_of(texture).size()};
    status = WebPDecode(bytes.data(), bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) throw undecodable(reason_of(status));
    return texture;
}

}  // namespace hilcam
