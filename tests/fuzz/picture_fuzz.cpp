// The header of any picture gives a size that is not 0, or none.

#include <cstddef>

#include "io/files/picture_size.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto found = hilcam::picture_size({data, size});
    HILCAM_CHECK(!found || (found->width > 0 && found->height > 0));
    return 0;
}
