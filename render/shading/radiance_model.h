#pragma once
// The light that a surface sends to the viewer by itself: the terms of equation (1) that need no recursion.
// It is one of the program's exchangeable models; recursion is the task of path_model.h.
//
//     reflected   Sun, bodies and lamps, reflected (the paper's equation without emission)
//     emissive    the same, and eps L_T of materials that have a temperature

#include <span>

#include "render/shading/tile.h"

namespace hilcam {

// The way in which the light of the Earth, the Moon and the planets on objects is found.
enum class BodySampling {
    kNone,     // not at all
    kSampled,  // one random direction to each, weighted against the path's own direction
};

class RadianceModel {
  public:
    virtual ~RadianceModel() = default;

    // Adds throughput times radiance towards the viewer, for each shading point, to the tile's pixels. All
    // shading points have the same depth. Loop, any thread.
    virtual void add_light(Tile& tile, std::span<const ShadingPoint> points, BodySampling lamps) const = 0;
    // True when the emission of materials is included.
    virtual bool emits() const = 0;
    // True when a surface that only the Sun lights has exactly f L cos and its emission. Such ground is then
    // computed without calling this model (render/ground_shading).
    virtual bool reflects_plainly() const { return false; }
};

}  // namespace hilcam
