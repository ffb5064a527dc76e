#pragma once
// Axes in which a scenario gives positions and attitudes: the world's, those of a turning body, local axes at
// a site on a body, a thing's own, or its orbit's.

#include "emulator/motion/motion_source.h"

namespace hilcam {

struct PlacedFrame {
    enum class Kind {
        kWorld,      // scenario's origin, ICRF axes
        kBodyFixed,  // centre of `center`, turning with it (Earth: ITRF)
        kLvlh,       // a thing's place, with the local vertical and horizontal of its orbit about `center`
        kThing,      // a thing's own axes
        kLocal       // east, north and up at `site` on the body `center`, turning with it
    } kind = Kind::kWorld;
    std::size_t thing = 0;
    OrbitCenter center;
    Geodetic site{};

    bool follows_thing() const { return kind == Kind::kLvlh || kind == Kind::kThing; }
    std::vector<MotionNeed> needs() const;
};

// Axes, and the state of their origin in the world.
struct PlacedAxes {
    StateVector origin;
    TurningAxes axes;
};
// Loop.
PlacedAxes axes_of(const PlacedFrame& frame, const MotionContext& context);
// Transforms a state from such axes to the world; the velocity includes omega x r. Loop.
StateVector world_state(const PlacedAxes& frame, const StateVector& in_frame);
// Transforms an attitude and body rate from such axes to the world. Loop.
AttitudeState world_attitude(const TurningAxes& axes, const AttitudeState& in_frame);
// Returns a thing's state about a centre, in ICRF axes. Loop.
StateVector about_center(const MotionContext& context, const StateVector& world, const OrbitCenter& center);

}  // namespace hilcam
