#pragma once
// Axes that a scenario gives positions and attitudes in: the world's, a body's that turns, a place's on a
// body, a thing's orbit's, a thing's own.

#include "emulator/motion/motion_source.h"

namespace hilcam {

struct PlacedFrame {
    enum class Kind {
        kWorld,      // the scenario's origin, ICRF axes
        kBodyFixed,  // the centre of `center`, with which it turns (Earth: ITRF)
        kLvlh,       // the thing, local vertical and horizontal of its orbit about `center`
        kThing,      // the thing's own axes
        kLocal       // east, north and up at `site` on the body `center`, with which they turn
    } kind = Kind::kWorld;
    std::size_t thing = 0;
    OrbitCenter center;
    Geodetic site{};

    bool follows_thing() const { return kind == Kind::kLvlh || kind == Kind::kThing; }
    std::vector<MotionNeed> needs() const;
};

// The place of its origin in the world, and its axes.
struct PlacedAxes {
    StateVector origin;
    TurningAxes axes;
};
// Loop.
PlacedAxes axes_of(const PlacedFrame& frame, const MotionContext& context);
// A state in such axes, in the world: omega x r is in its velocity. Loop.
StateVector world_state(const PlacedAxes& frame, const StateVector& in_frame);
// An attitude and body rate against such axes, against the world. Loop.
AttitudeState world_attitude(const TurningAxes& axes, const AttitudeState& in_frame);
// A thing's state about a centre, ICRF axes. Loop.
StateVector about_center(const MotionContext& context, const StateVector& world, const OrbitCenter& center);

}  // namespace hilcam
