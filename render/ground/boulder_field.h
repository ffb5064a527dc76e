#pragma once
// Seeded boulders. Their number follows a power law of the diameter, N(> D) = K D^-b (Cintala & McBride, NASA
// TM-104804, 1995: b of 2 to 3 at the Surveyors' sites), with K from the share of the ground that they cover
// (rock abundance; Bandfield et al., J. Geophys. Res. 116, E00H02, 2011). Each is a half-buried stone of
// seeded shape: an ellipsoid cut by planes. It is part of the ground's heights, so it has no overhangs, and
// it exists only where vertices are close enough to show it, so invisible ones cost nothing.

#include <cstdint>
#include <vector>

#include "render/ground/ground_detail.h"
#include "render/ground/seeded_octaves.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct BoulderSettings {
    std::int64_t seed = 1;
    double abundance = 0.02;  // share of the ground covered by boulders between the two diameters
    double exponent = 2.5;    // b
    double smallest_m = 0.1, largest_m = 10;
};
Fields fields(BoulderSettings& settings);
void validate(const BoulderSettings& settings);

struct Boulder {
    Vec3d place;            // unit vector
    double diameter_m = 0;  // largest width
    double height_m = 0;    // above the ground
};

class BoulderField final : public GroundDetail {
  public:
    // factor: on the settings' abundance, by place; null: none.
    BoulderField(double radius_m, const BoulderSettings& settings,
                 std::shared_ptr<const SeededFactor> factor = nullptr);
    void add(const GroundPatch& patch) const override;
    // Appends the boulders above a diameter whose middles are within an angle of a direction.
    void find(Vec3d middle, double reach_rad, double smallest_m, std::vector<Boulder>& boulders) const;
    // Returns the number per square metre above a diameter: by the settings, and at a place.
    double per_m2(double diameter_m) const;
    double per_m2_at(Vec3d place, double diameter_m) const;

  private:
    static constexpr int kPlanes = 6;
    struct Shaped : Boulder {
        double turn_rad = 0, slim = 1;     // ratio of the smaller to the larger width
        std::array<Vec3d, kPlanes> plane;  // unit normals, in units of the half axes
        std::array<double, kPlanes> plane_at;
        double bright = 1;
    };
    double radius_m_;
    BoulderSettings settings_;
    std::shared_ptr<const SeededFactor> by_place_;
    double factor_;  // K
    SeededOctaves octaves_;

    double diameter_m(const SeededOctaves::Thing& thing) const;
    Shaped shaped(const SeededOctaves::Thing& thing) const;
    void add_one(const Shaped& boulder, const GroundPatch& patch) const;
};

}  // namespace hilcam
