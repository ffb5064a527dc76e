#pragma once
// The sums of shifted tables that are a point's image (psf.h), in vectors. Every width of them gives the same bits.

#include <array>
#include <cstddef>

namespace hilcam {

// One of the tables that a point's image is a sum of: where in it the image's corner lies, and its weight.
struct ShiftedTable {
    const float* corner;
    float weight;
};

// The least image has seven rows and columns; its tables have eight of each, the last ones zero.
//
// Copies the sum of such tables, 64 numbers. Loop, any thread, as the next two.
void copy_least(const ShiftedTable* tables, std::size_t count, float* out);
// Adds rows of it, first to end. out: where the image's first pixel is, or would be.
void add_least(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first, std::ptrdiff_t end,
               float* out, std::ptrdiff_t pitch);

// A larger image: by the cubic's sixteen tables near the middle pixel, by a line's four where that is as good.
struct LargeImage {
    std::array<ShiftedTable, 16> cubic;
    std::array<ShiftedTable, 4> linear;
    std::ptrdiff_t pitch;                       // numbers from row to row of a table
    std::ptrdiff_t size, first_near, end_near;  // columns and rows alike
};
// Columns that are added together: up to seven zeros are added beyond a larger image.
inline constexpr std::ptrdiff_t kColumnsTogether = 8;
// Adds rows of the image, first to end. out: where its first pixel is, or would be.
void add_large(const LargeImage& image, std::ptrdiff_t first, std::ptrdiff_t end, float* out,
               std::ptrdiff_t pitch);

}  // namespace hilcam
