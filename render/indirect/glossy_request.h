#pragma once
// The work that the lookup of cached light leaves to rays for each shading point: the part of its facet lobe
// that is still missing.

#include "render/glossy/glossy_buffer.h"

namespace hilcam {

// A lobe with this reflectance is always examined: a glint in it is as bright as paint.
inline constexpr float kBrightLobe = 0.1f;

struct GlossyRequest {
    bool mirrors_near = true;      // something may be in the mirror direction
    bool has_bodies = false;       // the lobe's light of bodies has been added already
    GlossyPoint* point = nullptr;  // rays will follow its lobe; null: none will
};

}  // namespace hilcam
