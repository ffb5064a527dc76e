#pragma once
// Where seeded things of a body's ground are: each in a cell of a face of the cube (cube_sphere.h), of a size that goes with
// theirs, so that whoever looks at a place finds them without a list of all. The cell's number and the thing's own
// are all that its random numbers depend on: same seed, same place, same thing on every machine.

#include <cstdint>
#include <vector>

#include "render/ground/cube_sphere.h"
#include "render/vocabulary/random.h"

namespace hilcam {

// Cells of 2^bits x 2^bits on each face, for one octave of sizes.
class GroundCells {
  public:
    // cell_m: least width of a cell. 0 <= octave < 2^8: its own number.
    GroundCells(double radius_m, double cell_m, std::uint32_t octave);

    struct Cell {
        std::uint64_t number;
        int face;
        std::int32_t column, row;
    };
    // Appends the cells that have a point within an angle of a direction, and perhaps a few more, in the order of their
    // numbers.
    void find(Vec3d middle, double reach_rad, std::vector<Cell>& cells) const;
    // Returns the area of a cell [m^2], by that of its middle.
    double area_m2(const Cell& cell) const;
    // Returns a number of things of a mean (Poisson; by inversion), at most 255.
    int count(const Cell& cell, double mean, RandomKey seed, RandomPurpose purpose) const;
    // Returns the four random words of a thing in a cell. use: below 2^8.
    std::array<std::uint32_t, 4> words(const Cell& cell, int thing, std::uint32_t use, RandomKey seed,
                                       RandomPurpose purpose) const;
    // A word as a number between 0 and 1, neither of them.
    static double uniform(std::uint32_t word) { return static_cast<double>(uniform01(word)); }
    // Returns the direction of a point in the cell, (0, 0) to (1, 1).
    Vec3d direction(const Cell& cell, double x, double y) const;

  private:
    double radius_m_;
    int bits_;
    std::uint32_t octave_;
};

}  // namespace hilcam
