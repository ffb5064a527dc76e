// Replaces payload_ccsds_121.cpp in a build without libaec's header.

#include "io/packets/payload_encoder.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::unique_ptr<PayloadEncoder> make_ccsds_121_encoder() {
    throw refused("outputs.packets.payload", "ccsds_121 in a hilcam that was built without libaec",
                  "raw_le, raw_be, packed, or a hilcam that was built with libaec-dev installed");
}

}  // namespace hilcam
