// Replaces payload_jpeg_ls.cpp in a build without CharLS's header.

#include "io/packets/payload_encoder.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<PayloadEncoder> make_jpeg_ls_encoder() {
    throw refused("outputs.packets.payload", "jpeg_ls in a hilcam that was built without CharLS",
                  "raw_le, raw_be, packed, or a hilcam that was built with libcharls-dev installed");
}

}  // namespace hilcam
