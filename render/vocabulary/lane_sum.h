#pragma once
// Adds the lanes of a vector in an order that does not depend on the processor's vector width: one half is
// added to the other until one lane remains. Always inline, because loops with several versions use it
// (clones.h).

#include <array>
#include <cstddef>
#include <cstring>

namespace hilcam {

// Every processor has vectors of four lanes. They are written out because GCC 12 compiles a loop over halves
// through memory, where each step waits for the last.
template <std::size_t kLanes>
[[gnu::always_inline]] inline float lane_sum(const std::array<float, kLanes>& lanes) {
    static_assert((kLanes & (kLanes - 1)) == 0 && kLanes >= 4);
    using Four [[gnu::vector_size(16)]] = float;
    std::array<Four, kLanes / 4> fours;
    std::memcpy(fours.data(), lanes.data(), sizeof lanes);
    for (std::size_t half = fours.size() / 2; half > 0; half /= 2)
        for (std::size_t i = 0; i < half; ++i) fours[i] += fours[i + half];
    const Four sum = fours[0];
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

}  // namespace hilcam
