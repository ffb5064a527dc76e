#pragma once
// The light of lamps (lamp.h) on surfaces and into the camera.
//
// Every surface on a path sends one ray to each lamp that is on. That is a separate term beside the Sun's in
// equation (1): L = f(view, lamp) I(theta) cos(sigma) / d^2. A lamp is a point, which no path can meet by
// chance, so the term needs no weighting and no random numbers and adds no noise to what the camera sees.
// Lamps that are off cost nothing.
//
// Objects and terrain between surface and lamp cast shadows, and glass transmits as it does sunlight. Not
// modelled: bodies in between, dimming by air, light on bodies, lamps in mirrors.
//
// A lamp must be outside of closed meshes, also of the thing that carries it. It may be mounted on a surface:
// anything nearer to it than kLampClearance_m (lamp.h) casts no shadow.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "render/scene/scene.h"
#include "render/shading/point_field.h"
#include "render/shading/tile.h"

namespace hilcam {

// The light that arrives from a lamp at a place.
struct LampRay {
    Vec3d dir;  // to the lamp, unit
    double distance_m = 0;
    float per_m2 = 0;  // b(theta) / d^2: irradiance across the ray, relative to the intensity on the axis
};

// A lamp that is on, in one frame.
struct PlacedLamp {
    std::size_t number = 0;      // index in Lamps::all()
    Vec3d position_m;            // ray space (frame_context.h)
    Vec3d axis;                  // unit
    Spectrum intensity_w_sr_um;  // on the axis, at its level
    const LampBeam* beam = nullptr;

    // Finds the light at a place; returns false if there is none. Below a millimetre the lamp is as bright as
    // at a millimetre, because it is not a point there. At distance zero it has no direction and gives no
    // light. Loop, any thread.
    bool shines_on(Vec3d place_m, LampRay& ray) const;
};

// A scene's lamps.
class Lamps {
  public:
    // Throws InputError if there are more than kMaxLamps.
    explicit Lamps(std::vector<SceneLamp> lamps);
    Lamps(const Lamps&) = delete;  // not copied: placed lamps point to the beams
    Lamps& operator=(const Lamps&) = delete;

    // Places the lamps for a frame; world.lamps describes the same lamps. Loop.
    void place(const WorldSnapshot& world, Vec3d ray_space_world_m);

    const std::vector<SceneLamp>& all() const { return lamps_; }
    std::span<const PlacedLamp> lit() const { return {lit_.data(), lit_count_}; }

  private:
    std::vector<SceneLamp> lamps_;
    std::array<PlacedLamp, kMaxLamps> lit_;
    std::size_t lit_count_ = 0;
};

// Adds the lamps' light that shading points reflect to the tile's pixels. Loop, any thread.
void add_lamps_reflected(Tile& tile, std::span<const ShadingPoint> points);
// Adds points for lamps that shine into the camera. Loop.
void add_lamps_seen(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points);

}  // namespace hilcam
