#pragma once
// The air of a body, as the last three terms of equation (1) need it: tau_1 (Sun to surface), tau_2 (surface
// to camera), path radiance L_u and the sky's light on the ground.
//
// Points and directions are in the body's own axes with z stretched so that its ellipsoid is a sphere of the
// equatorial radius (heights err by 0.3 % at most on the Earth). Light amounts are per unit of solar
// irradiance at the body, per bin. A ray in air costs microseconds, so these are plain virtual calls.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class AirRefraction;  // air_refraction.h

class Atmosphere {
  public:
    virtual ~Atmosphere() = default;

    // Above the sphere [m]; rays that stay above meet no air.
    virtual double top_m() const = 0;

    struct Sight {
        Spectrum transmittance;  // tau_2
        Spectrum radiance_sr;    // L_u / E_s [sr^-1]
    };
    // Along a ray from `origin_m` (any height) for distance_m, or to its end in space when infinite. dir:
    // unit. Loop, any thread.
    virtual Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const = 0;
    // tau_1 from a point to the Sun; zero where the ground is between.
    virtual Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const = 0;
    // The sky's irradiance on a horizontal surface [1], scattered light only.
    virtual Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const = 0;
    // Says what keeps it from telling how a ray's way looks ("zenith angle of the viewer of 88.1; the table
    // reaches ..."); empty where it can.
    virtual std::string missing(Vec3d, Vec3d, double, Vec3d) const { return {}; }
    // Rays so far for which something was missing; they were given the nearest that there is.
    virtual std::uint64_t rays_outside() const { return 0; }
    // Returns how it bends rays; null: not at all. look() and the rest take straight rays, which who asks has bent before (AirRefraction::within).
    virtual const AirRefraction* refraction() const { return nullptr; }
    // One line for `hilcam check`.
    virtual std::string describe() const = 0;
};

struct AtmosphereConfig;  // atmosphere_config.h
struct AtmosphereTable;   // atmosphere_table.h

// Keeps from run to run what a model has computed.
class AtmosphereStore {
  public:
    virtual ~AtmosphereStore() = default;
    // Fills `values`, as many as there are, with those that were kept under the key; false: there are none.
    virtual bool find(std::span<const double> key, std::span<float> values) const = 0;
    virtual void keep(std::span<const double> key, std::span<const float> values) const = 0;
};

// The values from which an atmosphere is made.
struct AtmosphereRequest {
    const AtmosphereConfig& config;
    const SpectralGrid& grid;
    const AtmosphereTable* table = nullptr;  // the contents of config.table
    const AtmosphereStore* store = nullptr;  // null: nothing is kept
};

}  // namespace hilcam
