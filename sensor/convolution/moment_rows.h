#pragma once
// The inner loop of the kernels of parts of pixels (moment_kernels.h), by the widest vectors that the processor has.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr std::size_t kSubpixelBlock_px = 32;  // columns that are made together

// Two rows of a block, which have most of their input in common.
struct MomentRows {
    const float* in;          // differences: the first that the upper row's first pixel gets light of
    std::size_t side;         // floats from one row of differences to the next
    const std::uint8_t* lit;  // marks taps + 1 rows of differences that are not all zero
    const float* weights;     // the first row of the kernel; weights go up from row to row, left in a row
    std::size_t across;       // floats from one row of weights to the next
    int taps;                 // size of the kernel, across and down
};
// Writes what the differences give to the two rows, kSubpixelBlock_px sums each: upper, then lower. Every width of vectors gives
// the same bits. Loop, any thread.
void sum_moment_rows(const MomentRows& rows, float* out);

}  // namespace hilcam
