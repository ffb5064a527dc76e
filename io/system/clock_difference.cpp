#include "io/system/clock_difference.h"

#include <limits>

#include "io/system/monotonic.h"

namespace hilcam {

std::int64_t ahead_of_monotonic_ns(clockid_t clock) noexcept {
    std::int64_t fastest_ns = std::numeric_limits<std::int64_t>::max(), ahead_ns = 0;
    for (int i = 0; i < 3; ++i) {
        const std::int64_t before_ns = monotonic_ns(), other_ns = clock_ns(clock),
                           took_ns = monotonic_ns() - before_ns;
        if (took_ns >= fastest_ns) continue;
        fastest_ns = took_ns;
        ahead_ns = other_ns - before_ns - took_ns / 2;
    }
    return ahead_ns;
}

}  // namespace hilcam
