#pragma once
// The light of lamps (lamp.h) on surfaces and in the camera.
//
// Every surface that a path meets sends a ray to each lamp that is lit: a term of its own beside the Sun's in
// equation (1), L = f(view, lamp) I(theta) cos(sigma) / d^2. A lamp is a point, which no path's own direction
// can meet: nothing is weighed, nothing is drawn by chance, so a lamp adds no noise of its own to what the
// camera sees. Lamps that are off cost nothing.
//
// Between a surface and a lamp objects and terrain cast shadow, glass lets through what it does of the Sun's
// light. Not modelled: bodies between, dimming by air, light on bodies, lamps in mirrors.
//
// A lamp must be outside of closed meshes, its own thing's too. It may sit on a surface: what is nearer to it
// than kLampClearance_m (lamp.h) casts no shadow.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "render/scene/scene.h"
#include "render/shading/point_field.h"
#include "render/shading/tile.h"

namespace hilcam {

// The light that comes from a lamp to a place.
struct LampRay {
    Vec3d dir;  // to the lamp, unit
    double distance_m = 0;
    float per_m2 = 0;  // b(theta) / d^2: irradiance across the ray, over intensity on the axis
};

// A lamp that is lit, in one frame.
struct PlacedLamp {
    std::size_t number = 0;      // in Lamps::all()
    Vec3d position_m;            // ray space (frame_context.h)
    Vec3d axis;                  // unit
    Spectrum intensity_w_sr_um;  // on the axis, at its level
    const LampBeam* beam = nullptr;

    // False: nothing comes. Nearer than a millimetre a lamp is no point: it is as bright as there; at no
    // distance at all it has no direction, and does not shine. Loop, any thread.
    bool shines_on(Vec3d place_m, LampRay& ray) const;
};

// A scene's lamps.
class Lamps {
  public:
    // Throws InputError when there are more than kMaxLamps.
    explicit Lamps(std::vector<SceneLamp> lamps);
    Lamps(const Lamps&) = delete;  // not copied: what is placed points to the beams
    Lamps& operator=(const Lamps&) = delete;

    // Places the lamps for a frame; world.lamps are these. Loop.
    void place(const WorldSnapshot& world, Vec3d ray_space_world_m);

    const std::vector<SceneLamp>& all() const { return lamps_; }
    std::span<const PlacedLamp> lit() const { return {lit_.data(), lit_count_}; }

  private:
    std::vector<SceneLamp> lamps_;
    std::array<PlacedLamp, kMaxLamps> lit_;
    std::size_t lit_count_ = 0;
};

// Adds to the tile's pixels what shading points reflect of lamps. Loop, any thread.
void add_lamps_reflected(Tile& tile, std::span<const ShadingPoint> points);
// Lamps that shine into the camera: points. Loop.
void add_lamps_seen(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points);

}  // namespace hilcam
