#pragma once
// Rays that continue paths, and the background that they see where they meet nothing.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/shading/tile.h"

namespace hilcam {

// A ray that continues a path.
struct NextRay {
    const ShadingPoint* from;
    Vec3f origin_m;
    Vec3f dir;
    float density;      // density of the direction [sr^-1]; 0: exact
    float alpha_least;  // least alpha of the next shading point's facet lobe
    bool meets_sun;     // where exact: the Sun's disk has not been counted as a highlight
    Spectrum throughput;
    bool whole_lobe = false;            // it stands for all of a narrow facet lobe about it
    bool sees_bodies = true;            // false: their light in its lobe has been counted
    LightPart part = LightPart::kPath;  // the part of what it meets
    GlossyRay* glossy = nullptr;        // it is one of a lobe's; null: it is not
    // True for a mirror's ray, in whose place many go where it, or one beside it, meets but a part of what the mirror shows.
    bool may_be_many = false;

    // A lobe's ray stands for a cone of its density; an exact one goes on as it came.
    RayWidth width() const {
        const float spread = density > 0 ? std::min(0.5f, 0.25f / std::sqrt(density)) : 0.0f;
        return {from->footprint_m, spread};
    }
};

// Rays that are chosen, as many as there is room for.
struct NextRays {
    std::span<NextRay> room;
    std::size_t count = 0;

    bool full() const { return count == room.size(); }
    void add(const NextRay& ray) {
        if (!full()) room[count++] = ray;
    }
};

// Adds the background that a ray sees to what its shading point sends. Loop, any thread.
void add_background(Tile& tile, const NextRay& ray);
// Adds the share of that light which next-event estimation has not counted. True: a body has been met. Loop, any thread.
bool add_background_seen(const FrameContext& frame, const NextRay& ray, Spectrum& light);

}  // namespace hilcam
