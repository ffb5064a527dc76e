#pragma once
// Measures how much of a picture's error follows the screen: the tiles and squares that a renderer works by.
//
// What is kept for a square is even within it and jumps at its border. So the steps of the error from pixel to pixel
// are taken, without their sign, as Wang, Bovik and Evans do for the blocks of compressed pictures ("Blind measurement
// of blocking artifacts in images", IEEE ICIP 2000): borders of squares of p pixels that lie on the screen's grid,
// stripes and chessboards are a line at the frequency 1/p in them. The error itself would not do: squares of random
// heights have a zero of their spectrum there. Steps along the rows are transformed over the whole picture; of the
// spectrum the frequencies count that are even down the columns, which is where all rows agree. Steps down the columns
// likewise. Each step is capped at four times the median step: a reference has single pixels that are far off, and their
// steps would drown the rest.

#include <array>
#include <cstdint>
#include <span>

namespace hilcam {

inline constexpr std::array kGridPeriods_px = {8, 16, 32};

// Powers, in any unit, that add up over pictures: at the frequency of each period, and the mean of its
// neighbours' (two to five steps of the spectrum away, none of them at a multiple of the grid's frequency).
struct GridEnergy {
    std::array<double, kGridPeriods_px.size()> at{}, beside{};

    GridEnergy& operator+=(const GridEnergy& other);
    // Returns all periods' together over their neighbours'. About 1: nothing follows the grid. 0 without any error.
    double ratio() const;
    double ratio(std::size_t period) const;
};

// A picture of values, row by row, and whether each counts.
struct MaskedValues {
    int width = 0, height = 0;
    std::span<const float> values;
    std::span<const std::uint8_t> counts;  // steps count between two pixels that both do
};
// Owner thread; allocates.
GridEnergy grid_energy(const MaskedValues& error);

}  // namespace hilcam
