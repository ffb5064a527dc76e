#pragma once
// The difference of two of the machine's clocks.

#include <time.h>

#include <cstdint>

namespace hilcam {

// Returns how far a clock is ahead of CLOCK_MONOTONIC. Two clocks cannot be read at the same instant: the
// fastest of three readings counts, to half of its length (some 50 ns). Loop.
std::int64_t ahead_of_monotonic_ns(clockid_t clock) noexcept;

}  // namespace hilcam
