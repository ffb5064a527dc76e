#pragma once
// The positions of the planets except the Earth: VSOP87 (Bretagnon & Francou, A&A 202, 309, 1988), version B,
// without terms below 5e-8 rad. Largest error of a coordinate compared with JPL's DE430 from 1950 to 2100, in
// arcsec as seen from the Earth or the Sun: Mercury and Venus 0.1, Mars 0.2, Jupiter and Saturn 0.3, Uranus
// 1.4, Neptune 2.1. The last two are VSOP87's own, which was fitted to DE200.

#include <cstdint>

#include "render/vocabulary/vec.h"

namespace hilcam {

enum class Planet : std::uint8_t { kMercury, kVenus, kMars, kJupiter, kSaturn, kUranus, kNeptune };

// Heliocentric and geometric, ICRF axes; from Jupiter outwards, of the planet with its moons.
struct PlanetState {
    Vec3d position_au, velocity_au_d;
};
// tdb_days: since J2000 (JD 2451545.0 TDB). Any thread; loop: a pure function of its arguments, up to 10 us.
PlanetState planet_by_series(Planet planet, double tdb_days);

}  // namespace hilcam
