#pragma once
// Turns strips of a frame into the payload of packets. Each strip is encoded by itself, so that a receiver
// can decode it without the others. Encoders are used on the output's own thread and may allocate.
//
// CCSDS 121.0, JPEG-LS and JPEG 2000 are done by libaec, CharLS and OpenJPEG, each loaded when it is needed
// (io/system/loaded_library.h). Each has one source, and another in its place for builds without its headers.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/packets/payload.h"
#include "render/vocabulary/image.h"

namespace hilcam {

// Some rows of a frame, in their order.
struct Strip {
    std::span<const std::uint16_t> dn;  // width * rows values of at most `bits` bits
    int width = 0, rows = 0;
    int bits = 0;  // 1 to 16
};
// Returns rows `first` to `first + rows - 1` of a frame.
Strip strip_of(const DnImage& frame, int first, int rows, int bits);

class PayloadEncoder {
  public:
    virtual ~PayloadEncoder() = default;
    // Appends the strip's payload. Throws DeviceError when the library reports an error.
    virtual void encode(const Strip& strip, std::vector<std::uint8_t>& out) = 0;
};

// Returns the encoder. Throws InputError with the name of the library that this build or this machine lacks.
std::unique_ptr<PayloadEncoder> make_payload_encoder(Payload payload);

std::unique_ptr<PayloadEncoder> make_raw_encoder(Payload payload);  // also packed
std::unique_ptr<PayloadEncoder> make_ccsds_121_encoder();
std::unique_ptr<PayloadEncoder> make_jpeg_ls_encoder();
std::unique_ptr<PayloadEncoder> make_jpeg_2000_encoder();

}  // namespace hilcam
