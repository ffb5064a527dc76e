#pragma once
// The world's frame at one instant: states of the central bodies in it, and other axes relative to its own,
// which are ICRF's. Positions are geometric, not apparent, because orbits are about the true place of a body.
// Results are computed once, on demand.

#include <optional>
#include <string_view>

#include "render/sky/bodies.h"

namespace hilcam {

// The centre of an orbit: a body, or the Sun if empty.
struct OrbitCenter {
    std::optional<BodyId> body = BodyId::kEarth;
    friend bool operator==(const OrbitCenter&, const OrbitCenter&) = default;
};
// Gravitational parameter [m^3/s^2], TDB-compatible: DE440 (Park, Folkner, Williams & Boggs, Astron. J.
// 161:105, 2021, table 2). From Jupiter to Neptune, moons are included.
double gravity_m3_s2(const OrbitCenter& center);

// Turning axes: their rotation into ICRF, and their rate relative to ICRF, in ICRF axes.
struct TurningAxes {
    Mat3d icrf_from_axes;
    Vec3d rate_rad_s;
};

// An object of this class must not be shared between threads. Loop: no allocation.
class WorldFrame {
  public:
    WorldFrame(TimeTai time, const OriginConfig& origin) : time_(time), origin_(origin) {}
    // Returns the same frame at another instant.
    WorldFrame at(TimeTai time) const { return {time, origin_}; }

    TimeTai time() const { return time_; }
    // Returns position and velocity in the world.
    StateVector center(const OrbitCenter& center) const;
    // Returns a body's own axes; the Earth's are ITRF.
    TurningAxes body_fixed(BodyId body) const;
    // Returns the axes of SGP4's orbits (earth_frames.h).
    Mat3d icrf_from_teme() const;
    // Returns the Earth's axes by its rotation about the celestial intermediate pole: ITRF without polar
    // motion.
    TurningAxes earth_rotated() const;

  private:
    TimeTai time_;
    OriginConfig origin_;
    mutable std::optional<StateVector> origin_state_;  // relative to the origin's central body
    mutable std::optional<TurningAxes> earth_;
};

// Returns the local vertical, local horizontal axes of an orbit: z points to the centre, y against the
// orbit's normal, and x completes them (along the velocity of a circular orbit). Fehse, Automated Rendezvous
// and Docking of Spacecraft, 2003, section 3.1.3. The rate is that of the radius vector, exact while the
// orbit's plane is at rest. For a thing without angular momentum, returns the nearest axes to ICRF's.
TurningAxes lvlh_axes(const StateVector& about_center);

}  // namespace hilcam
