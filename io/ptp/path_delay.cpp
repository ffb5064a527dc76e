#include "io/ptp/path_delay.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

void PathDelay::add(const DelayExchange& exchange) { exchanges_[count_++ % kKept] = exchange; }

std::int64_t PathDelay::median_ns(double master_rate) const {
    const std::size_t kept = std::min(count_, kKept);
    if (kept == 0) return 0;
    std::array<std::int64_t, kKept> delays{};
    for (std::size_t i = 0; i < kept; ++i) {
        const DelayExchange& e = exchanges_[i];
        const std::int64_t here_ns = e.t3_monotonic_ns - e.t2_monotonic_ns;
        const std::int64_t gain_ns = std::llround(static_cast<double>(here_ns) * master_rate);
        delays[i] = (e.t4_ns - e.t1_ns - here_ns - gain_ns) / 2;
    }
    const auto end = delays.begin() + static_cast<std::ptrdiff_t>(kept);
    std::sort(delays.begin(), end);
    return (delays[(kept - 1) / 2] + delays[kept / 2]) / 2;
}

}  // namespace hilcam
