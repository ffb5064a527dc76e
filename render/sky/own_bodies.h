#pragma once
// Round bodies that the scenario adds to the Moon and the planets: moons of other planets, asteroids,
// invented moons. They are drawn, shine, cast shadows on each other and on the planets, and hide stars like
// the others.
//
// A body's position is that of its orbit about its centre, added to where the centre is seen, at the time
// when the light left it: the centre's aberration is used.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/sky/bodies.h"

namespace hilcam {

struct OwnBody {
    std::string name;
    Figure figure{};
    std::optional<BodyId> center;  // none: the Sun
    // Returns the state about the centre [m, m/s], ICRF axes. Loop, any thread.
    std::function<StateVector(TimeTai)> orbit;
    // Its axes: z to the pole; x towards the centre (synchronous, z along the orbit's normal), or at an angle
    // from the node on ICRF's equator at J2000 and rotating at a rate (Archinal et al. 2018, figure 1).
    bool synchronous = true;
    double pole_right_ascension_rad = 0, pole_declination_rad = 0.5 * kPi;
    double meridian_rad = 0, rate_rad_s = 0;
    // Its axes from kernels, which replace those above. Loop, any thread.
    std::function<Mat3d(TimeTai)> turn;
};
struct OwnBodies {
    std::vector<OwnBody> list;  // kMaxOwnBodies at most
};

// Returns the seconds of TT since J2000.
double seconds_since_j2000(TimeTai time);
// Returns its axes at an instant from its state about its centre.
Mat3d fixed_from_icrf(const OwnBody& body, const StateVector& about_center, TimeTai time);
// Adds them to `bodies`, in which the planets are placed already. home: the body that the origin belongs to.
// Loop.
void place_own_bodies(TimeTai time, const OwnBodies& own, std::optional<BodyId> home, Bodies& bodies);

}  // namespace hilcam
