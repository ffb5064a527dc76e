#pragma once
// The device's clock as a straight line over CLOCK_MONOTONIC:
//     device_ns(t) = device_ns + (t - monotonic_ns) (1 + rate)
// With monotonic_ns 5e9, device_ns 1e9 and rate 100e-6, t = 15e9 gives 11'001'000'000. Results outside int64
// are its nearest values. Loop.

#include <cmath>
#include <cstdint>
#include <limits>

namespace hilcam {

struct ClockLine {
    std::int64_t monotonic_ns = 0, device_ns = 0;
    double rate = 0;  // gain over CLOCK_MONOTONIC, a ratio; above -1

    std::int64_t device_at(std::int64_t t_monotonic_ns) const {
        const std::int64_t since_ns = minus(t_monotonic_ns, monotonic_ns);
        return plus(plus(device_ns, since_ns), part(since_ns, rate));
    }
    // The inverse of device_at(), to 1 ns.
    std::int64_t monotonic_at(std::int64_t t_device_ns) const {
        const std::int64_t since_ns = minus(t_device_ns, device_ns);
        return minus(plus(monotonic_ns, since_ns), part(since_ns, rate / (1 + rate)));
    }

  private:
    using Limits = std::numeric_limits<std::int64_t>;
    static std::int64_t plus(std::int64_t a, std::int64_t b) {
        std::int64_t sum = 0;
        if (!__builtin_add_overflow(a, b, &sum)) return sum;
        return b > 0 ? Limits::max() : Limits::min();
    }
    static std::int64_t minus(std::int64_t a, std::int64_t b) {
        std::int64_t difference = 0;
        if (!__builtin_sub_overflow(a, b, &difference)) return difference;
        return b < 0 ? Limits::max() : Limits::min();
    }
    // The small part is computed alone: a double holds 2^53 ns, a time since 1970 has more.
    static std::int64_t part(std::int64_t ns, double ratio) {
        return std::llround(static_cast<double>(ns) * ratio);
    }
};

}  // namespace hilcam
