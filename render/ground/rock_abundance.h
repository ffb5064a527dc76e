#pragma once
// The share of the ground that boulders cover, from maps of rock abundance (such as Diviner's: Bandfield et
// al., J. Geophys. Res. 116, E00H02, 2011), as a factor on the share in the settings.

#include <mutex>
#include <vector>

#include "render/ground/ground_surface.h"
#include "render/ground/seeded_octaves.h"

namespace hilcam {

class RockAbundance final : public SeededFactor {
  public:
    // maps: of kind kRockAbundance. elsewhere: the share outside the maps. seeded: the share in the settings.
    RockAbundance(const Figure& figure, std::vector<GroundMap> maps, double elsewhere, double seeded);
    void find(std::span<const Vec3d> places, std::span<double> factors) const override;

  private:
    mutable std::mutex mutex_;  // surface_ allows one thread at a time
    mutable GroundSurface surface_;
    double elsewhere_, seeded_;
};

}  // namespace hilcam
