#include "io/packets/payload_encoder.h"

namespace hilcam {

Strip strip_of(const DnImage& frame, int first, int rows, int bits) {
    const auto width = static_cast<std::size_t>(frame.width());
    return {
        frame.all().subspan(static_cast<std::size_t>(first) * width, static_cast<std::size_t>(rows) * width),
        frame.width(), rows, bits};
}

std::unique_ptr<PayloadEncoder> make_payload_encoder(Payload payload) {
    switch (payload) {
        case Payload::kCcsds121:
            return make_ccsds_121_encoder();
        case Payload::kJpegLs:
            return make_jpeg_ls_encoder();
        case Payload::kJpeg2000:
            return make_jpeg_2000_encoder();
        case Payload::kRawLittleEndian:
        case Payload::kRawBigEndian:
        case Payload::kPacked:
            break;
    }
    return make_raw_encoder(payload);
}

}  // namespace hilcam
