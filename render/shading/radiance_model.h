#pragma once
// The light that a surface sends towards the viewer by itself: the terms of equation (1) that need no
// recursion. One of the program's exchangeable models; the recursion is path_model.h's.
//
//   reflected   Sun, bodies and lamps, reflected (the paper's equation without emission)
//   emissive    the same, and eps L_T of materials that have a temperature

#include <span>

#include "render/shading/tile.h"

namespace hilcam {

// The rays that find the light of the Earth, the Moon and the planets on the objects.
enum class BodySampling {
    kNone,     // nobody
    kSampled,  // one random direction to each, weighed against the path's own direction
};

class RadianceModel {
  public:
    virtual ~RadianceModel() = default;

    // Adds to the tile's pixels, shading point by shading point, throughput times radiance towards the viewer. All shading points
    // are of one depth. Loop, any thread.
    virtual void add_light(Tile& tile, std::span<const ShadingPoint> points, BodySampling lamps) const = 0;
    // The materials' own emission counts.
    virtual bool emits() const = 0;
    // True where of a surface that the Sun alone shines on it has f L cos, and its emission, and nothing else: such ground is
    // worked out without asking it (render/ground_shading).
    virtual bool reflects_plainly() const { return false; }
};

}  // namespace hilcam
