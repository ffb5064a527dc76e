#pragma once
// Adds the lanes of a vector in one order, whatever width of vectors the processor has: halves are added to
// each other. Inline: compiled into loops that have several versions (clones.h).

#include <array>
#include <cstddef>

namespace hilcam {

template <std::size_t kLanes>
[[gnu::always_inline]] inline float lane_sum(std::array<float, kLanes> lanes) {
    static_assert((kLanes & (kLanes - 1)) == 0);
    for (std::size_t half = kLanes / 2; half > 0; half /= 2)
        for (std::size_t i = 0; i < half; ++i) lanes[i] += lanes[i + half];
    return lanes[0];
}

}  // namespace hilcam
