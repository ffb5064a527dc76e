#include "render/ground/seeded_octaves.h"

#include <algorithm>

namespace hilcam {

SeededOctaves::SeededOctaves(double radius_m, std::int64_t seed, RandomPurpose purpose, double smallest_m,
                             double largest_m, const std::function<double(double)>& per_m2,
                             const std::function<double(const Octave&)>& cell_m)
    : radius_m_(radius_m), seed_{static_cast<std::uint64_t>(seed), 0}, purpose_(purpose) {
    std::uint32_t number = 0;
    for (double least_m = smallest_m; least_m < largest_m; least_m *= 2) {
        const double most_m = std::min(2 * least_m, largest_m);
        Octave octave{least_m, most_m, per_m2(least_m) - per_m2(most_m), per_m2(most_m),
                      GroundCells(radius_m, 1, 0)};
        octave.cells = GroundCells(radius_m, cell_m(octave), number++);
        octaves_.push_back(octave);
    }
}

}  // namespace hilcam
