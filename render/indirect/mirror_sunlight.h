#pragma once
// Sunlight that flat mirrors (probes/flat_mirrors.h) throw on other surfaces: each of them shows a second Sun,
// behind its plane, to those that stand before it. A ray from the surface towards it asks whether the mirror
// is met first, another from there whether the Sun is seen; what comes along is the Sun's irradiance times
// the mirror's reflectance (material_albedo.h).
//
// The Sun is a point at its middle where a mirror's facets scatter less than its disk does: the edge of the
// light is the mirror's own, as sharp as a shadow is (with sun_is_disk its place is drawn, as everywhere).
// Rough mirrors widen it. The approximation: what a surface sees of a mirror's lobe is what the mirror fills
// of three rectangles about the place where it would see the Sun's middle, as large as facets turn light that
// lean by GGX's slopes (kRectangles below), the disk's half light added in squares. All comes from the
// middle, or from the place of the mirror that is nearest to it; what stands in the way of that is in the way
// of all. What adds less than contribution_threshold of the Sun fades out.
//
// Not here: mirrors that are curved, have a texture, or are objects without cached light; light that two
// mirrors have thrown; the lobes of what is lit where they are too narrow to be cached (rays follow these).

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
    // One with the Sun in it, in ray space.
    struct Shown {
        Mirror mirror;
        Vec3f normal;  // on the side where the Sun is
        Vec3f corner_m, across, down;
        Spectrum reflectance;
        float tolerance_m;  // greatest distance of its level of detail from the plane
        // The distance by which a facet that leans by alpha moves the place where the Sun is seen, over the
        // distance, along across and down; 0: the mirror is as sharp as its edge.
        Vec2f blur{};
        Vec3f dir{};           // towards the mirrored Sun's middle
        ReflectedBeam beam{};  // where anything of it counts
    };

    // An object's mirrors and its materials' albedos, by surface; all outlive this. Owner thread.
    void add(const ShownObject& object, std::size_t number, std::span<const FlatMirror> mirrors,
             std::span<const MaterialAlbedo> albedos);

    // Takes the mirrors that the Sun shines on. The frame's objects and background are placed. Loop.
    void place(const FrameContext& frame, const WorldSnapshot& world);

    // Adds to the tile's pixels what shading points reflect of it. Loop, any thread.
    void add_light(Tile& tile, std::span<const ShadingPoint> points) const;

  private:
    std::vector<Mirror> mirrors_;
    std::vector<Shown> shown_;
    ReflectedBeams beams_;  // the beams of shown_

    void add_light_of(const Shown& shown, Tile& tile, std::span<const ShadingPoint> points,
                      BeamPlaces& places) const;
};

}  // namespace hilcam
