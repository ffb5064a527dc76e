#pragma once
// The air of a body, as the last three terms of equation (1) need it: tau_1 (Sun to surface), tau_2 (surface
// to camera), path radiance L_u and the sky's light on the ground.
//
// Points and directions are in the body's own axes, with z stretched so that its ellipsoid is a sphere of the
// equatorial radius (errors of heights on the Earth are at most 0.3 %). Light is per unit of solar irradiance
// at the body, per bin. A ray in air costs microseconds, so these are plain virtual calls.

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

    // Returns the air's upper limit above the sphere [m]; rays above it meet no air.
    virtual double top_m() const = 0;

    struct Sight {
        Spectrum transmittance;  // tau_2
        Spectrum radiance_sr;    // L_u / E_s [sr^-1]
    };
    // Returns transmittance and radiance along a ray from `origin_m` (any height) for distance_m, or to its
    // end in space if that is infinite. dir: unit. Loop, any thread.
    virtual Sight look(Vec3d origin_m, Vec3d dir, double distance_m, Vec3d sun_dir) const = 0;
    // Returns tau_1 from a point to the Sun; zero if the ground is in between.
    virtual Spectrum sun_transmittance(Vec3d point_m, Vec3d sun_dir) const = 0;
    // Returns the sky's irradiance on a horizontal surface [1], scattered light only.
    virtual Spectrum sky_irradiance(Vec3d point_m, Vec3d sun_dir) const = 0;
    // Says which data are missing for a ray ("zenith angle of the viewer of 88.1; the table reaches ...");
    // empty if none.
    virtual std::string missing(Vec3d, Vec3d, double, Vec3d) const { return {}; }
    // Returns the number of rays so far for which data were missing; the nearest data were used.
    virtual std::uint64_t rays_outside() const { return 0; }
    // Returns how the air bends rays; null if it does not. look() and the other functions take straight rays:
    // the caller bends them first (AirRefraction::within).
    virtual const AirRefraction* refraction() const { return nullptr; }
    // Returns one line for `hilcam check`.
    virtual std::string describe() const = 0;
};

struct AtmosphereConfig;  // atmosphere_config.h
struct AtmosphereTable;   // atmosphere_table.h

// Stores what a model has computed from run to run.
class AtmosphereStore {
  public:
    virtual ~AtmosphereStore() = default;
    // Fills `values` with those stored under the key, of the same number; returns false if there are none.
    virtual bool find(std::span<const double> key, std::span<float> values) const = 0;
    virtual void keep(std::span<const double> key, std::span<const float> values) const = 0;
};

// The ingredients of an atmosphere.
struct AtmosphereRequest {
    const AtmosphereConfig& config;
    const SpectralGrid& grid;
    const AtmosphereTable* table = nullptr;  // contents of config.table
    const AtmosphereStore* store = nullptr;  // null: nothing is stored
};

}  // namespace hilcam
