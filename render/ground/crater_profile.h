#pragma once
// The profile of a crater, fresh or worn: height above the surrounding ground by the distance from its
// middle.
//
// Fresh: a parabolic bowl with a depth of 0.196 D^1.010 below a rim of height 0.036 D^1.014 (D in km; Pike,
// in Impact and Explosion Cratering, 489, 1977). Outside, ejecta fall with the third power of the distance
// (McGetchin et al., Earth Planet. Sci. Lett. 20, 226, 1973), to zero at kReach radii. Worn: the same after
// diffusion of its heights; wear is diffusivity times time over the squared radius (Fassett & Thomson, J.
// Geophys. Res. Planets 119, 2255, 2014). Not modelled: flat floors and terraces of craters above 15 km, the
// shapes of secondary craters.

#include <vector>

namespace hilcam {

class CraterProfile {
  public:
    static constexpr double kReach = 3;      // radii
    static constexpr double kMaxWorn = 0.5;  // a tenth of the depth remains

    CraterProfile();
    static constexpr int kSteps = 192;  // tabulated distances, up to kReach

    // The profile at one wear, between two tabulated ones: heights at kSteps + 1 distances, for a fresh depth
    // of 1.
    struct Worn {
        const double* fresher = nullptr;
        const double* older = nullptr;
        double share = 0;  // weight of `older`
    };
    // worn: 0 to kMaxWorn. Valid as long as this object.
    Worn at(double worn) const;
    // Returns the height in radii at a distance in radii; 0 beyond kReach. depth: of a fresh crater below its
    // rim, in radii.
    double height(double distance, double worn) const;
    // Returns the depth of a fresh crater below its rim, over its diameter.
    static double fresh_depth(double diameter_m);

  private:
    static constexpr int kStates = 24;
    std::vector<std::vector<double>> states_;  // by wear, then by distance; for a fresh depth of 1
};

}  // namespace hilcam
