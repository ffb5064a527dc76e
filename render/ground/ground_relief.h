#pragma once
// Relief between the posts of a map: a fractal surface. Height differences over a distance d have the root
// mean square `deviation_m` (d / at_m)^hurst, as the map's own heights have at larger distances (structure
// function; Rosenburg et al., J. Geophys. Res. 116, E02001, 2011, for the Moon). It is made of octaves of
// gradient noise (Perlin, SIGGRAPH 02) in space, from twice the map's spacing down to the finest that is
// needed.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/ground/ground_detail.h"
#include "render/ground/ground_surface.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct ReliefSettings {
    std::int64_t seed = 1;
    double longest_m = 0;  // wavelength of the first octave; 0 in a configuration: from measured_relief()
    // Root mean square of height differences over at_m; 0 in a configuration: from measured_relief().
    double deviation_m = 0;
    double at_m = 100;
    double hurst = 0.9;
};
Fields fields(ReliefSettings& settings);

// Measures the relief of a map: fits the power law to root-mean-square differences over 1, 2 and 4 spacings
// at places all over the body. None if the body has no map of heights, or a flat one.
std::optional<ReliefSettings> measured_relief(GroundSurface& surface, double spacing_m);

class GroundRelief final : public GroundDetail {
  public:
    GroundRelief(double radius_m, const ReliefSettings& settings);
    void add(const GroundPatch& patch) const override;
    void add_wide(const GroundPatch& patch) const override;
    const ReliefSettings& settings() const { return settings_; }

  private:
    double radius_m_;
    ReliefSettings settings_;
    std::vector<double> wavelength_m_, amplitude_m_;

    void add_octaves(const GroundPatch& patch, double min_m, double below_m) const;
};

}  // namespace hilcam
