#pragma once
// The work that the lookup of cached light leaves to rays, for each shading point: which part of its facet lobe is still to be found.

#include "render/glossy/glossy_buffer.h"

namespace hilcam {

// A lobe of this reflectance is looked into in any case: a glint in it is as bright as paint.
inline constexpr float kBrightLobe = 0.1f;

struct GlossyRequest {
    bool mirrors_near = true;      // something may stand in the mirror's direction
    bool has_bodies = false;       // the light of bodies in the lobe has been added
    GlossyPoint* point = nullptr;  // rays are to follow its lobe; null: they are not
};

}  // namespace hilcam
