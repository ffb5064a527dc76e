#pragma once
// Where the Sun shines from on a vertex: from the middle of its disk, or from a place on it that is drawn.

#include <cmath>

#include "render/light/tile.h"
#include "render/scene/brdf_microfacet.h"

namespace hilcam {

class SunSampler {
  public:
    explicit SunSampler(const Tile& tile)
        : tile_(tile),
          background_(*tile.frame.background),
          center_(to_float(background_.sun_world_dir())),
          axis_(center_),
          // 1 - cos of a small angle by its sine: single precision has no digits left for it.
          sine_squared_(
              static_cast<float>(1 - background_.sun_disk_cosine() * background_.sun_disk_cosine())) {}

    // Of directions on the disk [sr^-1].
    float disk_density() const { return 1 / (kPiF * sine_squared_); }
    struct Sample {
        Vec3f dir;       // unit
        Spectrum light;  // irradiance, as if all came from there
    };
    Sample of(const Vertex& at) const {
        const Spectrum& irradiance = background_.sun_irradiance_w_m2_um();
        if (!tile_.frame.sun_is_disk) return {center_, irradiance};
        const auto random = tile_.random_of(at, 1);
        const float u1 = uniform01(random[0]), phi = 2 * kPiF * uniform01(random[1]);
        const float r = std::sqrt(u1 * sine_squared_);
        return {normalized(axis_.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)})),
                irradiance * background_.sun_disk().relative_radiance(std::sqrt(1 - u1))};
    }

  private:
    const Tile& tile_;
    const Background& background_;
    Vec3f center_;
    Frame axis_;
    float sine_squared_;
};

}  // namespace hilcam
