#pragma once
// The inner loop of the kernels of halves of pixels (half_kernels.h), by the widest vectors that the processor has.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr std::size_t kHalfBlock_px = 32;  // columns that are made together

// Two rows of a block, which have most of their input in common.
struct HalfRows {
    const float* in;          // differences: the first that the upper row's first pixel gets light of
    std::size_t side;         // floats from one row of them to the next
    const std::uint8_t* lit;  // of taps + 1 rows of them: whether any is not zero
    const float*
        weights;  // those of the first row of the kernel; rows of weights go upwards, in them to the left
    std::size_t across;  // floats from one row of them to the next
    int taps;            // of the kernel, across and down
};
// Writes what the differences give to the two rows, kHalfBlock_px sums each: upper, then lower. Every width of vectors gives the
// same bits. Loop, any thread.
void sum_half_rows(const HalfRows& rows, float* out);

}  // namespace hilcam
