#pragma once
// Air that shines evenly up to its top, and lets all light through.

#include <string>

#include "render/sky/atmosphere.h"

namespace hilcam {

class EvenAir final : public Atmosphere {
  public:
    double top_m() const override { return 1e5; }
    Sight look(Vec3d, Vec3d, double, Vec3d) const override { return {all(1), all(1)}; }
    Spectrum sun_transmittance(Vec3d, Vec3d) const override { return all(1); }
    Spectrum sky_irradiance(Vec3d, Vec3d) const override { return {}; }
    std::string describe() const override { return "even"; }

  private:
    static Spectrum all(float value) {
        Spectrum out;
        out.bin.fill(value);
        return out;
    }
};

}  // namespace hilcam
