#pragma once
// The ways in which pixels of a strip are stored in packets. The numbers are those of the secondary header's
// field `payload`.

#include <cstdint>

namespace hilcam {

enum class Payload : std::uint8_t {
    kRawLittleEndian = 0,  // 16 bits a pixel, the DN in the lower bits
    kRawBigEndian = 1,
    kPacked = 2,    // bit after bit, least significant first, as Mono12p of PFNC
    kCcsds121 = 3,  // CCSDS 121.0-B-3, lossless data compression
    kJpegLs = 4,    // ISO/IEC 14495-1 (ITU-T T.87), lossless
    kJpeg2000 = 5,  // ISO/IEC 15444-1 (ITU-T T.800), reversible; a codestream without a file's boxes
};

}  // namespace hilcam
