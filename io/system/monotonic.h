#pragma once
// The machine's clocks as nanoseconds.

#include <time.h>

#include <cstdint>

namespace hilcam {

inline std::int64_t clock_ns(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
inline std::int64_t monotonic_ns() { return clock_ns(CLOCK_MONOTONIC); }
// Returns how long the process's threads have had a processor, all together.
inline std::int64_t processor_ns() { return clock_ns(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace hilcam
