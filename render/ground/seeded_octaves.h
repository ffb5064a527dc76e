#pragma once
// Seeded things on a body's ground, with numbers by a law of the diameter. They are sorted into octaves of
// diameters, each with its own cells (ground_cells.h). A cell draws the number of its things, and for each
// the place and the rank among the octave's diameters; each kind of thing draws its other properties itself.
// A factor by place changes the numbers in each cell; peaks of the factor that are narrower than a cell (at
// least a thing's width) may be cut off.

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/ground/ground_cells.h"
#include "render/ground/ground_detail.h"

namespace hilcam {

// A factor by place on the number of things.
class SeededFactor {
  public:
    virtual ~SeededFactor() = default;
    // Finds one factor for each place. Any thread.
    virtual void find(std::span<const Vec3d> places, std::span<double> factors) const = 0;
};

class SeededOctaves {
  public:
    struct Octave {
        double min_m, max_m;   // diameters
        double per_m2;         // number between the two
        double larger_per_m2;  // number above the larger one
        GroundCells cells;
    };

    // A thing as its cell draws it, before it has a shape.
    class Thing {
      public:
        Vec3d place;  // unit vector
        double above =
            0;  // number per square metre of larger things; the inverse of the law gives its diameter
        double spare = 0;  // a random number between 0 and 1 that is not used yet

        Thing(const SeededOctaves& from, const Octave& octave, const GroundCells::Cell& cell, int index)
            : from_(from), octave_(octave), cell_(cell), index_(index) {
            const auto first = words(0);
            place =
                octave.cells.direction(cell, GroundCells::uniform(first[0]), GroundCells::uniform(first[1]));
            above = octave.larger_per_m2 + GroundCells::uniform(first[2]) * octave.per_m2;
            spare = GroundCells::uniform(first[3]);
        }
        // Returns four random words. use: 1 to 253.
        std::array<std::uint32_t, 4> words(std::uint32_t use) const {
            return octave_.cells.words(cell_, index_, use, from_.seed_, from_.purpose_);
        }

      private:
        const SeededOctaves& from_;
        const Octave& octave_;
        const GroundCells::Cell& cell_;
        int index_;
    };

    // per_m2: the law, the number per square metre above a diameter. cell_m: smallest width of an octave's
    // cells.
    SeededOctaves(double radius_m, std::int64_t seed, RandomPurpose purpose, double smallest_m,
                  double largest_m, const std::function<double(double diameter_m)>& per_m2,
                  const std::function<double(const Octave&)>& cell_m,
                  std::shared_ptr<const SeededFactor> factor = nullptr);

    // Calls f(thing) for things whose middles are within an angle of a direction, in the octaves above a
    // diameter; some may be smaller than that.
    template <class F>
    void visit_within(Vec3d middle, double reach_rad, double smallest_m, const F& f) const {
        for (const Octave& octave : octaves_)
            if (octave.max_m > smallest_m)
                visit(octave, middle, reach_rad, [&](const Thing& thing) {
                    if (length(thing.place - middle) <= 2 * std::sin(0.5 * reach_rad)) f(thing);
                });
    }
    // Calls f(thing) for all things that may show on a patch, and possibly a few more. min_texels: smaller
    // diameters are left out. reach: how far a thing extends from its middle, in diameters.
    template <class F>
    void visit_on(const GroundPatch& patch, double min_texels, double reach, const F& f) const {
        for (const Octave& octave : octaves_)
            if (octave.min_m >= min_texels * patch.texel_m)
                visit(octave, patch.middle, patch.reach_rad + reach * octave.max_m / radius_m_, f);
    }

  private:
    double radius_m_;
    RandomKey seed_;
    RandomPurpose purpose_;
    std::vector<Octave> octaves_;
    std::shared_ptr<const SeededFactor> factor_;  // null: the law everywhere

    // Returns the largest factor at a cell's middle and corners.
    double max_factor(const Octave& octave, const GroundCells::Cell& cell) const;
    // Decides, by the factor at its own place, whether a thing drawn for the largest factor is kept.
    bool is_kept(const Thing& thing, double most) const;

    template <class F>
    void visit(const Octave& octave, Vec3d middle, double reach_rad, const F& f) const {
        std::vector<GroundCells::Cell> cells;
        octave.cells.find(middle, reach_rad, cells);
        for (const GroundCells::Cell& cell : cells) {
            const double most = factor_ ? max_factor(octave, cell) : 1;
            const int count =
                octave.cells.count(cell, most * octave.per_m2 * octave.cells.area_m2(cell), seed_, purpose_);
            for (int k = 0; k < count; ++k)
                if (const Thing thing(*this, octave, cell, k); !factor_ || is_kept(thing, most)) f(thing);
        }
    }
};

}  // namespace hilcam
