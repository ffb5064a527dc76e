#pragma once
// Rays that continue paths, and the background that they see if they meet nothing.

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
    float alpha_least;  // smallest alpha of the next shading point's facet lobe
    bool meets_sun;     // for exact rays: the Sun's disk has not been counted as a highlight
    Spectrum throughput;
    bool whole_lobe = false;            // it represents the whole narrow facet lobe around it
    bool sees_bodies = true;            // false: their light in its lobe has been counted
    LightPart part = LightPart::kPath;  // part of the light that it finds
    GlossyRay* glossy = nullptr;        // it belongs to a lobe with shared rays; null: it does not
    // True for a mirror's ray that becomes many if it, or one beside it, meets only a part of what the mirror
    // shows.
    bool may_be_many = false;

    // The ray of a lobe represents a cone, as wide as its density says; an exact ray keeps its width.
    RayWidth width() const {
        const float spread = density > 0 ? std::min(0.5f, 0.25f / std::sqrt(density)) : 0.0f;
        return {from->footprint_m, spread};
    }
};

// A list of chosen rays, limited by its memory.
struct NextRays {
    std::span<NextRay> room;
    std::size_t count = 0;

    bool full() const { return count == room.size(); }
    void add(const NextRay& ray) {
        if (!full()) room[count++] = ray;
    }
};

// Adds the background that a ray sees to the light of the shading point that it left. Loop, any thread.
void add_background(Tile& tile, const NextRay& ray);
// Adds the share of that light which next-event estimation has not counted. Returns true if a body was met.
// Loop, any thread.
bool add_background_seen(const FrameContext& frame, const NextRay& ray, Spectrum& light);

}  // namespace hilcam
