#pragma once
// Sunlight that flat mirrors (probes/flat_mirrors.h) reflect onto other surfaces. A surface in front of a
// mirror sees a second Sun behind the mirror's plane. One ray from the surface tests whether the mirror is
// met first, another from there whether it sees the Sun; the light is the Sun's irradiance times the mirror's
// reflectance (material_albedo.h). See docs/rendering.md, "The Sun in flat mirrors".
//
// For a mirror that scatters less than the Sun's disk, the Sun is a point, and the light has the mirror's own
// sharp edges (with sun_is_disk its place is drawn at random, as everywhere). Rough mirrors widen it.
// Approximation: the share of the lobe that the mirror fills is the share that it fills of five nested
// rectangles around the place where the surface would see the Sun's middle (kRectangles, made of GGX slopes),
// with the half-light radius of the Sun's disk added in quadrature. One ray to a filled place in the middle
// of the rectangle that contributes most decides for all of it whether it is visible and lit. Light fades out
// below contribution_threshold of the Sun.
//
// Not included: mirrors that are curved, textured, or on objects without cached light; light by way of two
// mirrors; and narrow lobes of the lit surface, which rays follow.

#include <cstdint>
#include <span>
#include <vector>

#include "render/indirect/reflected_beam.h"
#include "render/probes/flat_mirrors.h"
#include "render/scene/material_albedo.h"
#include "render/scene/shown_object.h"
#include "render/shading/tile.h"

namespace hilcam {

class MirrorSunlight {
  public:
    // A flat mirror of an object.
    struct Mirror {
        const ShownObject* object;
        std::uint32_t number;  // number of the object
        const FlatMirror* shape;
        const MaterialAlbedo* albedo;
        float alpha;
    };
    // A mirror that the Sun shines on, in ray space.
    struct Shown {
        Mirror mirror;
        Vec3f normal;  // on the Sun's side
        Vec3f corner_m, across, down;
        Spectrum reflectance;
        float tolerance_m;  // largest distance of its level of detail from the plane
        // The shift of the place where the Sun is seen for a facet that leans by alpha, per unit of
        // distance, along across and down; 0: the mirror is as sharp as its edge.
        Vec2f blur{};
        Vec3f dir{};           // towards the middle of the mirrored Sun
        ReflectedBeam beam{};  // where its light counts
    };

    // Adds an object's mirrors. albedos: of its materials, by surface. All must outlive this. Owner thread.
    void add(const ShownObject& object, std::size_t number, std::span<const FlatMirror> mirrors,
             std::span<const MaterialAlbedo> albedos);

    // Selects the mirrors that the Sun shines on. The frame's objects and background are placed. Loop.
    void place(const FrameContext& frame, const WorldSnapshot& world);

    // Adds the mirrored sunlight that shading points reflect to the tile's pixels. Loop, any thread.
    void add_light(Tile& tile, std::span<const ShadingPoint> points) const;

  private:
    std::vector<Mirror> mirrors_;
    std::vector<Shown> shown_;
    ReflectedBeams beams_;  // the beams of shown_

    void add_light_of(const Shown& shown, Tile& tile, std::span<const ShadingPoint> points,
                      BeamPlaces& places) const;
};

}  // namespace hilcam
