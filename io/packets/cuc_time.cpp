#include "io/packets/cuc_time.h"

#include <cmath>

namespace hilcam {
namespace {

// From 1958-01-01 to 1970-01-01 there are 4383 days of 86,400 s of TAI.
constexpr std::int64_t kFrom1958To1970_s = 4383 * 86'400;

}  // namespace

void write_cuc(TimeTai time, ByteWriter& out) {
    std::int64_t seconds = time.ns / kSecond_ns, rest_ns = time.ns % kSecond_ns;
    if (rest_ns < 0) --seconds, rest_ns += kSecond_ns;
    // The largest rest, 999,999,999 ns, rounds to 2^32 - 4: it never carries into the seconds.
    const auto fraction = std::llround(std::ldexp(static_cast<double>(rest_ns), 32) * 1e-9);
    out.u16(kCucPreamble)
        .u32(static_cast<std::uint32_t>(seconds + kFrom1958To1970_s))
        .u32(static_cast<std::uint32_t>(fraction));
}

}  // namespace hilcam
