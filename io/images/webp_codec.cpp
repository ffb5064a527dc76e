#include <webp/decode.h>

#include <new>

#include "io/images/picture_codecs.h"

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

namespace {

// Lets libwebp write rows, with this many bytes per pixel, into the memory that `room` returns for a width
// and a height.
template <class Room>
void decode_into(PictureBytes bytes, WEBP_CSP_MODE mode, int pixel_bytes, const Room& room) {
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) throw undecodable("libwebp: another version of it was expected");
    VP8StatusCode status = WebPGetFeatures(bytes.data(), bytes.size(), &config.input);
    if (status != VP8_STATUS_OK) throw undecodable(reason_of(status));
    if (config.input.has_animation) throw PictureFault("is an animation; accepted: one picture");
    const std::span<std::uint8_t> out =
        room(static_cast<std::uint64_t>(config.input.width), static_cast<std::uint64_t>(config.input.height));
    config.output.colorspace = mode;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {out.data(), pixel_bytes * config.input.width, out.size()};
    status = WebPDecode(bytes.data(), bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) throw undecodable(reason_of(status));
}

}  // namespace

Texture decode_webp(PictureBytes bytes) {
    Texture texture;
    decode_into(bytes, MODE_RGB, 3, [&](std::uint64_t width, std::uint64_t height) {
        texture = blank_texture(width, height);
        return bytes_of(texture);
    });
    return texture;
}

std::vector<std::uint8_t> decode_webp_alpha(PictureBytes bytes) {
    std::vector<std::uint8_t> samples;
    decode_into(bytes, MODE_RGBA, 4, [&](std::uint64_t width, std::uint64_t height) {
        require_few_pixels(width, height);
        samples.resize(4 * width * height);
        return std::span(samples);
    });
    return every_fourth(samples);
}

}  // namespace hilcam
