#pragma once
// The shape of a crater, fresh or worn: heights over the ground around, by the distance from its middle.
//
// Fresh: a bowl as deep under its rim as 0.196 D^1.010 and a rim as high as 0.036 D^1.014 (D, in km; Pike, in Impact and
// Explosion Cratering, 489, 1977), a parabola inside; outside the ejecta fall as the third power of the distance (McGetchin et al.,
// Earth Planet. Sci. Lett. 20, 226, 1973) to nothing at kReach radii. Worn: the same after diffusion of its heights, whose
// measure is diffusivity times time over the radius squared (Fassett & Thomson, J. Geophys. Res. Planets 119, 2255, 2014). Not
// modelled: flat floors and terraces of craters above 15 km, secondary craters' shapes.

#include <vector>

namespace hilcam {

class CraterProfile {
  public:
    static constexpr double kReach = 3;      // radii
    static constexpr double kMaxWorn = 0.5;  // a tenth of the depth is left

    CraterProfile();
    static constexpr int kSteps = 192;  // distances at which heights are kept, to kReach

    // The shape at one wear lies between two that are kept: heights at kSteps + 1 distances, of a depth of 1 under the rim when fresh.
    struct Worn {
        const double* fresher = nullptr;
        const double* older = nullptr;
        double share = 0;  // the share of the second
    };
    // worn: 0 to kMaxWorn. Valid as long as this is.
    Worn at(double worn) const;
    // Returns the height over the radius at a distance in radii; 0 beyond kReach. depth: of a fresh crater under its rim,
    // over the radius.
    double height(double distance, double worn) const;
    // Depth under the rim over the diameter of a fresh crater.
    static double fresh_depth(double diameter_m);

  private:
    static constexpr int kStates = 24;
    std::vector<std::vector<double>> states_;  // by wear, by distance; of a fresh depth of 1
};

}  // namespace hilcam
