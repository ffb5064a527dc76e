#pragma once
// Adds the lanes of a vector in one order, whatever width of vectors the processor has: halves are added to
// each other. Inline: compiled into loops that have several versions (clones.h).

#include <array>
#include <cstddef>
#include <cstring>

namespace hilcam {

// Four lanes together are a vector of every processor. They are written out, as GCC 12 makes a loop through memory of halves,
// whose parts wait for each other.
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
