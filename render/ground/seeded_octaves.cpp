#include "render/ground/seeded_octaves.h"

#include <algorithm>

namespace hilcam {

SeededOctaves::SeededOctaves(double radius_m, std::int64_t seed, RandomPurpose purpose, double smallest_m,
                             double largest_m, const std::function<double(double)>& per_m2,
                             const std::function<double(const Octave&)>& cell_m,
                             std::shared_ptr<const SeededFactor> factor)
    : radius_m_(radius_m),
      seed_{static_cast<std::uint64_t>(seed), 0},
      purpose_(purpose),
      factor_(std::move(factor)) {
    std::uint32_t number = 0;
    for (double min_m = smallest_m; min_m < largest_m; min_m *= 2) {
        const double max_m = std::min(2 * min_m, largest_m);
        Octave octave{min_m, max_m, per_m2(min_m) - per_m2(max_m), per_m2(max_m),
                      GroundCells(radius_m, 1, 0)};
        octave.cells = GroundCells(radius_m, cell_m(octave), number++);
        octaves_.push_back(octave);
    }
}

double SeededOctaves::max_factor(const Octave& octave, const GroundCells::Cell& cell) const {
    const auto at = [&](double x, double y) { return octave.cells.direction(cell, x, y); };
    const std::array<Vec3d, 5> places = {at(0.5, 0.5), at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
    std::array<double, 5> factors{};
    factor_->find(places, factors);
    return *std::max_element(factors.begin(), factors.end());
}

bool SeededOctaves::is_kept(const Thing& thing, double most) const {
    constexpr std::uint32_t kKeptUse = 254;
    double factor = 0;
    factor_->find({&thing.place, 1}, {&factor, 1});
    return GroundCells::uniform(thing.words(kKeptUse)[0]) * most < factor;
}

}  // namespace hilcam
