#pragma once
// Things of a body's ground that are seeded by a law of how many there are above a diameter: octaves of diameters, each in cells
// (ground_cells.h) of its own size. A cell draws how many of its octave are in it, and for each the place and the rank among
// the octave's diameters; what else a kind of thing has it draws itself. Where a place has more or fewer of them than the law, more
// or fewer are drawn in its cell; a factor's peaks that are narrower than a cell (a thing's width or more) may be cut.

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/ground/ground_cells.h"
#include "render/ground/ground_detail.h"

namespace hilcam {

// A factor by place says how many times as many things there are as the law says.
class SeededFactor {
  public:
    virtual ~SeededFactor() = default;
    // Finds as many factors as there are places. Any thread.
    virtual void find(std::span<const Vec3d> places, std::span<double> factors) const = 0;
};

class SeededOctaves {
  public:
    struct Octave {
        double min_m, max_m;   // diameters
        double per_m2;         // number of things between the two
        double larger_per_m2;  // number of things above the greater one
        GroundCells cells;
    };

    // A thing is what a cell says of it, before it has a shape.
    class Thing {
      public:
        Vec3d place;  // unit vector
        double above =
            0;  // number per square metre of larger things, by the law: the inverse of the law is its diameter
        double spare = 0;  // a number between 0 and 1 that is free

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

    // per_m2: the law, number per square metre of diameters above one. cell_m: least width of an octave's cells.
    SeededOctaves(double radius_m, std::int64_t seed, RandomPurpose purpose, double smallest_m,
                  double largest_m, const std::function<double(double diameter_m)>& per_m2,
                  const std::function<double(const Octave&)>& cell_m,
                  std::shared_ptr<const SeededFactor> factor = nullptr);

    // Calls f(thing) for those of octaves with diameters above one that have their middles within an angle of a direction; some
    // smaller ones are among them.
    template <class F>
    void visit_within(Vec3d middle, double reach_rad, double smallest_m, const F& f) const {
        for (const Octave& octave : octaves_)
            if (octave.max_m > smallest_m)
                visit(octave, middle, reach_rad, [&](const Thing& thing) {
                    if (length(thing.place - middle) <= 2 * std::sin(0.5 * reach_rad)) f(thing);
                });
    }
    // Calls f(thing) for all that may show on a patch, and perhaps a few more. min_texels: diameters of less are left out;
    // reach: how far from its middle a thing reaches, in its diameters.
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

    // Finds the greatest factor at a cell's middle and corners.
    double max_factor(const Octave& octave, const GroundCells::Cell& cell) const;
    // Says whether a thing that was drawn for that factor is one by the factor of its own place.
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
