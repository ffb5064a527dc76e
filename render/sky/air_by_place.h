#pragma once
// Air that is lit from below: an atmosphere which knows what ground and clouds send up again, other from place to place.
//
// Light above ground of albedo A is L_0 + f L_1 with f = A / (1 - A S): L_0 over black ground, L_1 what one unit of the light that
// comes down to it, sent up evenly, makes of itself in the air, S the share of L_1 that comes down again (Chandrasekhar, Radiative
// Transfer, 1960, sec. 72, for plane layers). L_0 and L_1 depend on no place, so that tables of them serve everywhere.

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/sky/atmosphere.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Ground and clouds together as the air above has them: albedos per bin on an equirectangular grid in the body's axes (left edge 180 W,
// rows from 90 N). One cell: the same everywhere.
struct AirGround {
    // By place, cells are some 5.6 degrees wide: about as far as the air at 30 km sees (its horizon is 5.6 degrees away).
    static constexpr int kWidth = 64, kHeight = kWidth / 2;

    int width = 1, height = 1;
    std::vector<Spectrum> albedo{};  // row by row
};

// Returns the ground whose cells have albedo_at(u, v) in their middles; u from 180 W, v from 90 N, 0..1.
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
    // Says what lies below. HILCAM_CHECK: as many albedos as cells. Not for the loop.
    virtual void put_over(AirGround ground) = 0;
    // True when it is not the same everywhere; else look() is all in over_black, and lift() zero.
    virtual bool lifts_by_place() const = 0;

    // The answer of look() in two parts: it is over_black with lift() times per_lift_sr added to its radiance.
    struct Parts {
        Sight over_black;
        Spectrum per_lift_sr;  // L_1
    };
    virtual Parts look_in_parts(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const = 0;
    // The answer of sky_irradiance(), likewise.
    struct Sky {
        Spectrum over_black, per_lift;
    };
    virtual Sky sky_in_parts(Vec3d point_m, Vec3d sun_dir) const = 0;
    // f at a place of the grid: u from 180 W, v from 90 N, 0..1; and below a point. Loop, any thread.
    virtual Spectrum lift_at(float u, float v) const = 0;
    Spectrum lift(Vec3d point_m) const {
        return lift_at(
            static_cast<float>(std::atan2(point_m.y, point_m.x) / (2 * kPi) + 0.5),
            static_cast<float>(0.5 - std::asin(std::clamp(point_m.z / length(point_m), -1.0, 1.0)) / kPi));
    }
};

}  // namespace hilcam
