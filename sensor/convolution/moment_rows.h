#pragma once
// The inner loop of moment_kernels.h, with the widest vectors of the processor.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr std::size_t kSubpixelBlock_px = 32;  // columns that are computed together

// Two rows of a block, which share most of their input.
struct MomentRows {
    const float* in;          // differences; the first that contributes to the upper row's first pixel
    std::size_t side;         // floats from one row of differences to the next
    const std::uint8_t* lit;  // marks of taps + 1 rows of differences that are not all zero
    const float* weights;     // first row of the kernel; weights rise from row to row and fall along a row
    std::size_t across;       // floats from one row of weights to the next
    int taps;                 // size of the kernel in both directions
};
// Computes the effect of the differences on two rows, kSubpixelBlock_px sums each: upper, then lower. Every
// vector width gives the same bits. Loop, any thread.
void sum_moment_rows(const MomentRows& rows, float* out);

}  // namespace hilcam
