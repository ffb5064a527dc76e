#pragma once
// Rays by which paths go on from shading points whose light is cached (indirect_cache.h). Nothing is drawn: they go into fixed
// directions, by mirrors, lobes too narrow to be cached, lobes whose cached light hangs on few directions, and glass. What can
// add less than contribution_threshold is left out.

#include "render/indirect/glossy_request.h"
#include "render/paths/next_ray.h"

namespace hilcam {

// Adds the rays of a shading point whose light is cached: a mirror's one direction, which may be many, those of a facet lobe, both
// of a sheet of glass. request: what the lookup has left to rays. Loop, any thread.
void add_glossy_rays(Tile& tile, const ShadingPoint& at, const GlossyRequest& request, NextRays& rays);

}  // namespace hilcam
