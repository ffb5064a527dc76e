#pragma once
// One instant of the world's frame: where the central bodies stand in it, and other axes against its own,
// ICRF. Geometric, not apparent: orbits are about where a body is. What is asked for is computed once and
// kept.

#include <optional>
#include <string_view>

#include "render/sky/bodies.h"

namespace hilcam {

// The centre of an orbit: the Sun (no body), or a body.
struct OrbitCenter {
    std::optional<BodyId> body = BodyId::kEarth;
    friend bool operator==(const OrbitCenter&, const OrbitCenter&) = default;
};
// Gravitational parameter [m^3/s^2], TDB-compatible: DE440 (Park, Folkner, Williams & Boggs, Astron. J.
// 161:105, 2021, table 2; from Jupiter to Neptune with their moons).
double gravity_m3_s2(const OrbitCenter& center);

// Axes that turn: from them into ICRF, and their rate against ICRF, in ICRF axes.
struct TurningAxes {
    Mat3d icrf_from_axes;
    Vec3d rate_rad_s;
};

// An object of this class is not shared between threads. Loop: no allocation.
class WorldFrame {
  public:
    WorldFrame(TimeTai time, const OriginConfig& origin) : time_(time), origin_(origin) {}
    // Another instant of it.
    WorldFrame at(TimeTai time) const { return {time, origin_}; }

    TimeTai time() const { return time_; }
    // Position and velocity in the world.
    StateVector center(const OrbitCenter& center) const;
    // A body's own axes; the Earth's are ITRF.
    TurningAxes body_fixed(BodyId body) const;
    // The axes of SGP4's orbits (earth_frames.h).
    Mat3d icrf_from_teme() const;
    // The Earth's axes by its rotation about the celestial intermediate pole: ITRF but for the pole's motion.
    TurningAxes earth_rotated() const;

  private:
    TimeTai time_;
    OriginConfig origin_;
    mutable std::optional<StateVector> origin_state_;  // against the origin's central body
    mutable std::optional<TurningAxes> earth_;
};

// Local vertical, local horizontal axes of an orbit about a centre: z to the centre, y against the orbit's
// normal, x completes them (along the velocity of a circular orbit). Fehse, Automated Rendezvous and Docking
// of Spacecraft, 2003, section 3.1.3. The rate is that of the radius vector; exact while the orbit's plane is
// at rest. A thing without angular momentum has the axes nearest to ICRF's.
TurningAxes lvlh_axes(const StateVector& about_center);

}  // namespace hilcam
