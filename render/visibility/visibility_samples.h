#pragma once
// Samples of a pixel on a rotated grid, and those of the visibility buffer: 4 x 4 in each of its pixels.
//
// Each sample has a cell of the pixel, and a column and a row to itself, so a strip thinner than a cell is
// seen whichever way it runs. With 64 samples edges in all directions are 7 % less exact than on a regular
// grid; edges and strips within three degrees of the pixels' axes are four to five times, diagonal strips
// twice as exact.

#include <cstddef>
#include <cstdint>

namespace hilcam {

inline constexpr int kVisibilityTile_px = 16;       // edge of a tile
inline constexpr int kVisibilitySamplesAcross = 4;  // in a pixel, across and down
inline constexpr int kVisibilitySamples = kVisibilitySamplesAcross * kVisibilitySamplesAcross;

// One bit for each sample of a pixel of the picture, which is one pixel of the buffer or four
// (pixel_samples.h).
using SampleMask = std::uint64_t;
inline constexpr std::size_t kMaxVisibilitySamples = 64;

// Where the samples of a buffer's pixels are: on the rotated grid, or in the middles of their cells, for
// buffers whose samples are pixels of the picture (ground_geometry()).
enum class SampleGrid { kRotated, kRegular };

// Returns the place of sample i of n x n on the rotated grid, which repeats after four samples. It is in cell
// (i % n, i / n).
constexpr float grid_x(int i, int n) {
    const int m = n < 4 ? n : 4;
    return (static_cast<float>(i % n) + (static_cast<float>(i / n % m) + 0.5f) / static_cast<float>(m)) /
           static_cast<float>(n);
}
constexpr float grid_y(int i, int n) {
    const int m = n < 4 ? n : 4;
    return (static_cast<float>(i / n) +
            (static_cast<float>(m - 1 - i % n % m) + 0.5f) / static_cast<float>(m)) /
           static_cast<float>(n);
}
constexpr float sample_x(int sample) { return grid_x(sample, kVisibilitySamplesAcross); }
constexpr float sample_y(int sample) { return grid_y(sample, kVisibilitySamplesAcross); }
// Returns where in its cell the sample of a row of cells (x), or of a column of cells (y), is [cells].
constexpr float in_cell_x(int row) { return (static_cast<float>(row) + 0.5f) / 4; }
constexpr float in_cell_y(int column) { return (3.5f - static_cast<float>(column)) / 4; }
// The first and the last place of samples in a pixel, across and down, on either grid.
inline constexpr float kFirstSample = 1.0f / 32, kLastSample = 31.0f / 32;

}  // namespace hilcam
