// Replaces payload_jpeg_2000.cpp in a build without OpenJPEG's header.

#include "io/packets/payload_encoder.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<PayloadEncoder> make_jpeg_2000_encoder() {
    throw refused("outputs.packets.payload", "jpeg_2000 in a hilcam that was built without OpenJPEG",
                  "raw_le, raw_be, packed, or a hilcam that was built with libopenjp2-7-dev installed");
}

}  // namespace hilcam
