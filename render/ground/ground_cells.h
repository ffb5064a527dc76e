#pragma once
// The places of seeded things on a body's ground. Each is in a cell of a cube's face (cube_sphere.h), whose
// size suits the things, so they can be found at any place without a list of all. Random numbers depend only
// on the cell's and the thing's number: the same seed gives the same things on every machine.

#include <cstdint>
#include <vector>

#include "render/ground/cube_sphere.h"
#include "render/vocabulary/random.h"

namespace hilcam {

// Cells of 2^bits x 2^bits on each face, for one octave of sizes.
class GroundCells {
  public:
    // cell_m: smallest width of a cell. octave: number of the octave, 0 to 2^8 - 1.
    GroundCells(double radius_m, double cell_m, std::uint32_t octave);

    struct Cell {
        std::uint64_t number;
        int face;
        std::int32_t column, row;
    };
    // Appends all cells with a point within an angle of a direction, and possibly a few more, ordered by
    // number.
    void find(Vec3d middle, double reach_rad, std::vector<Cell>& cells) const;
    // Returns the area of a cell [m^2], by the value at its middle.
    double area_m2(const Cell& cell) const;
    // Draws the number of things in a cell from a Poisson distribution (by inversion), at most 255.
    int count(const Cell& cell, double mean, RandomKey seed, RandomPurpose purpose) const;
    // Returns four random words for a thing in a cell. use: below 2^8.
    std::array<std::uint32_t, 4> words(const Cell& cell, int thing, std::uint32_t use, RandomKey seed,
                                       RandomPurpose purpose) const;
    // Returns a word as a number between 0 and 1, exclusive.
    static double uniform(std::uint32_t word) { return static_cast<double>(uniform01(word)); }
    // Returns the direction of a point in the cell, (0, 0) to (1, 1).
    Vec3d direction(const Cell& cell, double x, double y) const;

  private:
    double radius_m_;
    int bits_;
    std::uint32_t octave_;
};

}  // namespace hilcam
