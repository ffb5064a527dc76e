#pragma once
// Equation (1) of Peng et al. 2011 at one surface: L = eps L_T + E_s tau_1 cos(sigma) f + (light of the
// bodies) + (light of lamps, lamp_light.h). The Sun is a point at the middle of its disk, with highlights as
// wide as the disk makes them; or its disk is sampled.

#include <cmath>
#include <memory>

#include "render/brdf/microfacet.h"
#include "render/shading/radiance_model.h"

namespace hilcam {

std::unique_ptr<RadianceModel> make_radiance_equation(bool emission);

// Returns the density [sr^-1] of the directions that kSampled draws to all bodies together from a shading
// point. A path's own direction is weighted against it.
float planetshine_density(const FrameContext& frame, const ShadingPoint& at, Vec3f dir);
// Returns the same for the Sun's disk; 0 if the Sun is a point or the direction is outside its disk.
float sun_density(const FrameContext& frame, Vec3f dir);

// Chooses where the light of the Sun comes from at a shading point: the middle of its disk, or a random place
// on it. Loop, any thread.
class SunSampler {
  public:
    explicit SunSampler(const Tile& tile)
        : tile_(tile),
          background_(*tile.frame.background),
          center_(to_float(background_.sun_world_dir())),
          axis_(center_),
          // 1 - cos of a small angle, computed by its sine: single precision has no digits left for it.
          sine_squared_(
              static_cast<float>(1 - background_.sun_disk_cosine() * background_.sun_disk_cosine())) {}

    // Returns the density of directions on the disk [sr^-1].
    float disk_density() const { return 1 / (kPiF * sine_squared_); }
    struct Sample {
        Vec3f dir;       // unit
        Spectrum light;  // irradiance, as if all of it came from there
    };
    Sample of(const ShadingPoint& at) const {
        const Spectrum& irradiance = background_.sun_irradiance_w_m2_um();
        if (!tile_.frame.sun_is_disk) return {center_, irradiance};
        const auto random = tile_.random_of(at, 1);
        const float u1 = uniform01(random[0]), phi = 2 * kPiF * uniform01(random[1]);
        const float r = std::sqrt(u1 * sine_squared_);
        return {normalized(axis_.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)})),
                irradiance * background_.sun_disk().relative_radiance(std::sqrt(1 - u1))};
    }
    Vec3f middle() const { return center_; }
    // Returns direction i of `of`, spread evenly over the disk (Vogel, Math. Biosci. 44, 1979, 179).
    Vec3f on_disk(std::uint32_t i, std::uint32_t of) const {
        const float r = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(of) * sine_squared_);
        const float phi = 2 * kPiF * 0.61803399f * static_cast<float>(i);
        return axis_.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)});
    }

  private:
    const Tile& tile_;
    const Background& background_;
    Vec3f center_;
    Frame axis_;
    float sine_squared_;
};

}  // namespace hilcam
