#pragma once
// The share of the ground that boulders cover, by maps of it (rock abundance, as Diviner's: Bandfield et al., J. Geophys. Res. 116,
// E00H02, 2011), as a factor on the share that boulders were seeded for.

#include <mutex>
#include <vector>

#include "render/ground/ground_surface.h"
#include "render/ground/seeded_octaves.h"

namespace hilcam {

class RockAbundance final : public SeededFactor {
  public:
    // maps: of kind kRockAbundance. elsewhere: the share where there is none. seeded: the share that is seeded for.
    RockAbundance(const Figure& figure, std::vector<GroundMap> maps, double elsewhere, double seeded);
    void find(std::span<const Vec3d> places, std::span<double> factors) const override;

  private:
    mutable std::mutex mutex_;  // the surface takes one at a time
    mutable GroundSurface surface_;
    double elsewhere_, seeded_;
};

}  // namespace hilcam
