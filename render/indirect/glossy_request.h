#pragma once
// The work that the lookup of cached light leaves to rays, for each shading point: which part of its facet lobe is still to be found.

#include <cstdint>

namespace hilcam {

struct GlossyRequest {
    static constexpr std::uint32_t kNobody = 0xFFFFFFFF;

    bool mirrors_near = true;        // something may stand in the mirror's direction
    bool has_bodies = false;         // the light of bodies in the lobe has been added
    bool wants_glossy_rays = false;  // rays are to find what the lobe, which is not narrow, reflects
    std::uint32_t next =
        kNobody;  // where that, or one before: the next shading point that has the light of the same rays, by its number
    float cached_lobe = 0;             // where that, cached light in the lobe, greatest bin
    float cached_lobe_directions = 0;  // that bring it
};

}  // namespace hilcam
