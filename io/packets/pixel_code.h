#pragma once
// The 32-bit code of a strip's pixels once they are decompressed, by GenICam's Pixel Format Naming Convention
// (PFNC 2.4, 2019).

#include <cstdint>

#include "io/system/wire_format.h"

namespace hilcam {

// bits: significant bits of a DN, at most 16. packed: the "p" formats, which exist for 10, 12 and 14 bits; 8
// and 16 bits are the same packed. A DN of other bits has the code of the next larger format.
// Any thread; no allocation.
std::uint32_t pixel_code(int bits, bool packed, BayerPattern pattern);

}  // namespace hilcam
