#pragma once
// The CCSDS Unsegmented Time Code, level 1 (CUC, CCSDS 301.0-B-4, 3.2): a preamble field that says what
// follows, then seconds and their binary fraction since the CCSDS epoch, 1958-01-01T00:00:00 TAI.
//
// The preamble 0x9F04 means: epoch of 1958 (level 1), four octets of seconds, 3 + 1 octets of fraction. A
// unit of the fraction is 2^-32 s, so that a time of whole nanoseconds comes back exactly. Seconds begin anew
// at 0 after 2^32 (2094-02-07); times before 1958 count back from there.

#include <cstdint>

#include "io/system/bytes.h"
#include "render/vocabulary/time.h"

namespace hilcam {

inline constexpr std::uint16_t kCucPreamble = 0x9F04;
inline constexpr std::size_t kCucBytes = 10;  // preamble and time

// Any thread; no allocation.
void write_cuc(TimeTai time, ByteWriter& out);

}  // namespace hilcam
