#pragma once
// The machine's clocks as nanoseconds. Loop.

#include <time.h>

#include <cstdint>

namespace hilcam {

inline std::int64_t clock_ns(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
inline timespec timespec_of(std::int64_t ns) {
    return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
}
inline std::int64_t monotonic_ns() { return clock_ns(CLOCK_MONOTONIC); }
// Sleeps until that time; signals do not end it early.
inline void sleep_until_monotonic_ns(std::int64_t ns) {
    const timespec t = timespec_of(ns);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
    }
}
// Returns the processor time of all threads of the process.
inline std::int64_t processor_ns() { return clock_ns(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace hilcam
