#pragma once
// Air that is lit from below: an atmosphere that takes into account what ground and clouds reflect, which may
// differ from place to place.
//
// Light above ground of albedo A is L_0 + f L_1 with f = A / (1 - A S). L_0 is over black ground. L_1 is what
// the air makes of the ground's light, for uniform emission equal to one unit of the light that arrives
// there. S is the share of L_1 that returns to the ground (Chandrasekhar, Radiative Transfer, 1960, sec. 72,
// for plane layers). L_0 and L_1 do not depend on the place, so their tables hold everywhere.

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/sky/atmosphere.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Ground and clouds together, for the air above them: albedos per bin on an equirectangular grid in the
// body's axes (left edge 180 W, rows from 90 N). One cell: the same everywhere.
struct AirGround {
    // Cells are about 5.6 degrees wide: as far as the horizon of air at 30 km.
    static constexpr int kWidth = 64, kHeight = kWidth / 2;

    int width = 1, height = 1;
    std::vector<Spectrum> albedo{};  // row by row
};

// Returns a ground whose cells have albedo_at(u, v) at their middles; u from 180 W, v from 90 N, 0..1.
template <class AlbedoAt>
AirGround ground_by_place(const AlbedoAt& albedo_at) {
    AirGround out{AirGround::kWidth, AirGround::kHeight, {}};
    out.albedo.reserve(static_cast<std::size_t>(out.width * out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            out.albedo.push_back(albedo_at((static_cast<float>(x) + 0.5f) / AirGround::kWidth,
                                           (static_cast<float>(y) + 0.5f) / AirGround::kHeight));
    return out;
}

class AirByPlace : public Atmosphere {
  public:
    // Sets the ground below. HILCAM_CHECK: as many albedos as cells. Not for the loop.
    virtual void put_over(AirGround ground) = 0;
    // True when the ground differs by place; otherwise look() returns everything in over_black, and lift()
    // zero.
    virtual bool lifts_by_place() const = 0;

    // The result of look() in two parts: over_black, plus lift() times per_lift_sr in its radiance.
    struct Parts {
        Sight over_black;
        Spectrum per_lift_sr;  // L_1
    };
    virtual Parts look_in_parts(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const = 0;
    // The result of sky_irradiance() in the same parts.
    struct Sky {
        Spectrum over_black, per_lift;
    };
    virtual Sky sky_in_parts(Vec3d point_m, Vec3d sun_dir) const = 0;
    // Returns f at a place of the grid (u from 180 W, v from 90 N, 0..1), and below a point. Loop, any
    // thread.
    virtual Spectrum lift_at(float u, float v) const = 0;
    Spectrum lift(Vec3d point_m) const {
        return lift_at(
            static_cast<float>(std::atan2(point_m.y, point_m.x) / (2 * kPi) + 0.5),
            static_cast<float>(0.5 - std::asin(std::clamp(point_m.z / length(point_m), -1.0, 1.0)) / kPi));
    }
};

}  // namespace hilcam
