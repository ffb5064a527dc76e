#pragma once
// Adaptive sampling of facet lobes (Lee, Redner & Uselton, SIGGRAPH 85). A lobe starts with one ray or two,
// which its neighbours share. The spread of what they meet says how wrong its light may be. Rays are added to
// bring that down to some noises of a sensor.
//
// Approximation: rays that decide also count, so light that no first ray has met stays dark (Kirk & Arvo,
// SIGGRAPH 91).

#include "render/shading/tile.h"

namespace hilcam {

// Returns their number; 0: none. Rays of the lobe's tile are linked. Loop, any thread.
int further_rays(const Tile& tile, const GlossyPoint& lobe);

}  // namespace hilcam
