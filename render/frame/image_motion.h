#pragma once
// Measures how far the picture moves between two instants: points of what the camera sees are carried along
// by the things they belong to, and projected at both.
//
// The points: where a grid of 9 x 9 rays through the frame (of a scanning line: 9) meets objects and bodies
// at the frame's time; the middles and edges of the objects in view, which the grid may miss; and, for the
// stars, the directions of the frame's middle and corners. Both poses are those of the given worlds, so a
// turn about the boresight, parallax and things that spin are in it.
//
// A fixed direction d moves in the axes of a camera that turns with omega by d' = -omega x d; on the
// boresight the picture moves by f (-omega_y, +omega_x) [px/s], right and down.

#include <optional>
#include <span>

#include "render/frame/plan.h"
#include "render/scene/scene.h"
#include "render/shading/frame_context.h"
#include "render/vocabulary/point_source.h"

namespace hilcam {

struct ImageMotion {
    // Displacement of what fills most of the picture, right and down, as a mean over its points [px]; zero
    // where only sky is seen.
    Vec2d displacement_px{};
    double largest_px = 0;  // largest displacement of any point; 0: nothing moves
};

// A frame that is placed, and what has to be known of its things.
struct MovingFrame {
    const FrameContext& frame;
    std::span<const ObjectPlan> plans;  // per object, as radii_m
    std::span<const double> radii_m;
    std::optional<BodyId> terrain_body;  // body with which the last object, a terrain, turns
    bool has_terrain = false;
    bool has_stars = false;
};
// The world that the frame was placed in, terrain among its objects, and those at the ends; without.
struct Instants {
    const WorldSnapshot &middle, &before, &after;
};
// Loop.
ImageMotion image_motion(const MovingFrame& moving, const Instants& instants);
// The drifts of points: how far their objects' middles go against the stars behind them, times per_s. Loop.
void set_drifts(const MovingFrame& moving, const Instants& instants, double per_s,
                std::span<PointSource> points);

}  // namespace hilcam
