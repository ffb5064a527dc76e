#pragma once
// Measures how far the picture moves between two instants. Points that the camera sees move with the things
// they belong to, and are projected at both instants.
//
// The points are: the hits of a grid of 9 x 9 rays (9 for a line scanner) on objects and bodies at the
// frame's time; the middles and edges of objects in view, which the grid may miss; and, for the stars, the
// directions of the frame's middle and corners. Both poses come from the given worlds, so the motion includes
// turns about the boresight, parallax and spinning things.
//
// In a camera that turns with omega, a fixed direction d moves by d' = -omega x d; at the boresight the
// picture moves by f (-omega_y, +omega_x) [px/s], right and down.

#include <optional>
#include <span>

#include "render/frame/plan.h"
#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

struct ImageMotion {
    // Displacement of what fills most of the picture, right and down: the mean over its points [px]; zero if
    // only sky is seen.
    Vec2d displacement_px{};
    double largest_px = 0;  // largest displacement of any point; 0: nothing moves
};

// A placed frame and the data about its things.
struct MovingFrame {
    const FrameContext& frame;
    std::span<const ObjectPlan> plans;  // per object, like radii_m
    std::span<const double> radii_m;
    std::optional<BodyId> terrain_body;  // body that the terrain, the last object, rotates with
    bool has_terrain = false;
    bool has_stars = false;
};
// The world that the frame was placed in, with terrain among its objects; and the worlds at both ends,
// without it.
struct Instants {
    const WorldSnapshot &middle, &before, &after;
};
// Loop.
ImageMotion image_motion(const MovingFrame& moving, const Instants& instants);
// Sets the drift of each point: how far its object's middle moves against the stars behind it, times per_s.
// Loop.
void set_drifts(const MovingFrame& moving, const Instants& instants, double per_s,
                std::span<PointSource> points);

}  // namespace hilcam
