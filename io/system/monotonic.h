#pragma once
// CLOCK_MONOTONIC as nanoseconds.

#include <time.h>

#include <cstdint>

namespace hilcam {

inline std::int64_t monotonic_ns() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace hilcam
