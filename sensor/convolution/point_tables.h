#pragma once
// Sums of shifted tables that make the image of a point (psf.h), in vectors. Every vector width gives the
// same bits.

#include <array>
#include <cstddef>

namespace hilcam {

// One of the tables in the sum: the corner of the image in the table, and the weight.
struct ShiftedTable {
    const float* corner;
    float weight;
};

// The smallest image has seven rows and columns; its tables have eight of each, the last ones zero.
//
// Copies the sum of such tables, 64 numbers. Loop, any thread; so are the next two functions.
void copy_least(const ShiftedTable* tables, std::size_t count, float* out);
// Adds rows of the smallest image, first to end. out: place of the image's first pixel, even if outside.
void add_least(const ShiftedTable* tables, std::size_t count, std::ptrdiff_t first, std::ptrdiff_t end,
               float* out, std::ptrdiff_t pitch);

// A larger image: the cubic's sixteen tables near the middle pixel, and four tables of linear interpolation
// where they are as good.
struct LargeImage {
    std::array<ShiftedTable, 16> cubic;
    std::array<ShiftedTable, 4> linear;
    std::ptrdiff_t pitch;                       // numbers from row to row of a table
    std::ptrdiff_t size, first_near, end_near;  // the same for columns and rows
};
// Columns that are added together; up to seven zeros are added beyond a larger image.
inline constexpr std::ptrdiff_t kColumnsTogether = 8;
// Adds rows of the image, first to end. out: place of its first pixel, even if outside.
void add_large(const LargeImage& image, std::ptrdiff_t first, std::ptrdiff_t end, float* out,
               std::ptrdiff_t pitch);

}  // namespace hilcam
