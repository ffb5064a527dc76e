#include <turbojpeg.h>

#include <memory>
#include <new>
#include <string_view>

#include "io/images/picture_codecs.h"

namespace hilcam {
namespace {

struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};

// Surplus bytes give a warning from libjpeg and are ignored, as in every viewer. An incomplete picture is
// refused.
bool is_whole(tjhandle handle) {
    return tjGetErrorCode(handle) == TJERR_WARNING &&
           std::string_view(tjGetErrorStr2(handle)).find("remature end") == std::string_view::npos;
}

}  // namespace

Texture decode_jpeg(PictureBytes bytes) {
    const std::unique_ptr<void, Destroy> handle(tjInitDecompress());
    if (!handle) throw std::bad_alloc();
    const auto refuse = [&] { return undecodable(std::string("libjpeg: ") + tjGetErrorStr2(handle.get())); };
    int width = 0, height = 0, subsampling = 0, space = 0;
    const auto size = static_cast<unsigned long>(bytes.size());
    if (tjDecompressHeader3(handle.get(), bytes.data(), size, &width, &height, &subsampling, &space) != 0 &&
        tjGetErrorCode(handle.get()) != TJERR_WARNING)
        throw refuse();
    if (width < 1 || height < 1) throw refuse();
    if (space == TJCS_CMYK || space == TJCS_YCCK)
        throw PictureFault("is a JPEG for printing (CMYK); accepted: grey, or red, green and blue");
    Texture texture = blank_texture(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    if (tjDecompress2(handle.get(), bytes.data(), size, bytes_of(texture).data(), width, 0, height, TJPF_RGB,
                      0) != 0 &&
        !is_whole(handle.get()))
        throw refuse();
    return texture;
}

}  // namespace hilcam
