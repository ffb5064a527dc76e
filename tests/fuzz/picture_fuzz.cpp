// Any bytes have a header that gives a size which is not 0, or none; and are colours and numbers of that many
// pixels, or refused in one line.

#include <cstddef>
#include <string_view>

#include "io/images/picture_codecs.h"
#include "io/images/picture_file.h"
#include "io/images/picture_size.h"
#include "render/vocabulary/check.h"

namespace {

using namespace hilcam;

constexpr std::uint64_t kMaxPixels = 1u << 20;

void require_one_line(std::string_view words) { HILCAM_CHECK(words.find('\n') == std::string_view::npos); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto found = picture_size({data, size});
    HILCAM_CHECK(!found || (found->width > 0 && found->height > 0));
    // Larger ones cost time here and nothing else.
    if (found && found->width > kMaxPixels / found->height) return 0;
    try {
        const Texture texture = decode_texture({data, size}, "it");
        HILCAM_CHECK(texture.texels.size() ==
                     static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    try {
        decode_numbers({data, size});
    } catch (const PictureFault& fault) {
        require_one_line(fault.what());
    }
    return 0;
}
