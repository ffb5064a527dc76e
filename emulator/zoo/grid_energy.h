#pragma once
// Measures how much of a picture's error follows the screen grid: the tiles and squares in which a renderer
// works.
//
// An error that is constant within a square jumps at the square's border. So the absolute steps of the error
// from pixel to pixel are examined, as Wang, Bovik and Evans do for the blocks of compressed pictures ("Blind
// measurement of blocking artifacts in images", IEEE ICIP 2000). Borders of squares of p pixels on the screen
// grid, stripes and chessboards appear in their spectrum as a line at the frequency 1/p. The spectrum of the
// error itself would not do, because squares of random heights have a zero there.
//
// Steps along rows are transformed over the whole picture. Only frequencies that are constant down the
// columns count: there all rows agree. Steps down the columns are treated in the same way. Each step is
// capped at four times the median step, because single pixels of a reference may be far off and would drown
// the rest.

#include <array>
#include <cstdint>
#include <span>

namespace hilcam {

inline constexpr std::array kGridPeriods_px = {8, 16, 32};

// Powers in arbitrary units, which add up over pictures: at the frequency of each period, and the mean of its
// neighbours' (two to five steps of the spectrum away, none at a multiple of the grid's frequency).
struct GridEnergy {
    std::array<double, kGridPeriods_px.size()> at{}, beside{};

    GridEnergy& operator+=(const GridEnergy& other);
    // Returns the power at all periods over that of their neighbours. About 1: nothing follows the grid. 0
    // without any error.
    double ratio() const;
    double ratio(std::size_t period) const;
};

// A picture of values, row by row, with a mask.
struct MaskedValues {
    int width = 0, height = 0;
    std::span<const float> values;
    std::span<const std::uint8_t> counts;  // a step counts if both of its pixels do
};
// Owner thread; allocates.
GridEnergy grid_energy(const MaskedValues& error);

}  // namespace hilcam
