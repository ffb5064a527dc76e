#pragma once
// Seeded craters. Their number follows the law in crater_law.h. Each has a profile by its wear
// (crater_profile.h), a rim that is not quite round, and bright rays while it is young. Craters too small for
// a patch's spacing are left out.
//
// Wear: where craters form and disappear in equilibrium, wear is uniformly distributed up to the value at
// which craters are no longer counted (Fassett & Thomson 2014, see crater_profile.h). Larger craters, which
// have all survived, have wear up to that of the ground's age. Overlapping craters are added up.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/ground/crater_law.h"
#include "render/ground/crater_profile.h"
#include "render/ground/crater_shape.h"
#include "render/ground/ground_detail.h"
#include "render/ground/seeded_octaves.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct CraterSettings {
    std::int64_t seed = 1;
    double age_ga = 3.5;
    double smallest_m = 0.2, largest_m = 1000;
    double diffusivity_m2_ga = 5500;  // Fassett & Thomson 2014: 5.5 m^2/Ma
    double rays = 0.5;                // approximate largest brightening by rays
};
Fields fields(CraterSettings& settings);
void validate(const CraterSettings& settings);

struct Crater {
    Vec3d place;  // unit vector
    double diameter_m = 0;
    double worn = 0;  // see CraterProfile
};

class CraterField final : public GroundDetail {
  public:
    // Octaves are counted from the body's smallest crater.
    CraterField(double radius_m, const CraterSettings& settings);
    void add(const GroundPatch& patch) const override;
    // Appends the craters above a diameter whose middles are within an angle of a direction.
    void find(Vec3d middle, double reach_rad, double smallest_m, std::vector<Crater>& craters) const;
    // Returns the number per square metre above a diameter, which is the same everywhere.
    double per_m2(double diameter_m) const { return law_.per_m2(diameter_m); }
    double per_m2_at(Vec3d, double diameter_m) const { return per_m2(diameter_m); }

  private:
    double radius_m_;
    CraterSettings settings_;
    CraterLaw law_;
    CraterProfile profile_;
    SeededOctaves octaves_;

    Crater crater_of(const SeededOctaves::Thing& thing) const;
    double bright_of(const Crater& crater) const;
    CraterShape shape_of(const Crater& crater, const SeededOctaves::Thing& thing) const;
};

}  // namespace hilcam
