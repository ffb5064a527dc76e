#pragma once
// The light that ground and clouds send back into the air, by place: f = A / (1 - A S) for albedo A, where
// the air returns the share S of it (air_by_place.h).

#include <string>
#include <vector>

#include "render/sky/air_by_place.h"

namespace hilcam {

class AirLift {
  public:
    // returned: S. HILCAM_CHECK: as many albedos as cells.
    AirLift(AirGround ground, const Spectrum& returned);
    static AirGround even(double albedo);

    bool varies() const { return lifts_.size() > 1; }
    const Spectrum& first() const { return lifts_.front(); }
    // Returns f, bilinear between the middles of cells; u from 180 W, v from 90 N. Loop, any thread.
    Spectrum at(float u, float v) const;
    // Returns, for example, "over albedo 0.25", for `hilcam check`.
    std::string describe() const;

  private:
    AirGround ground_;
    std::vector<Spectrum> lifts_;
};

}  // namespace hilcam
