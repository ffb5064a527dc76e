#pragma once
// The rays by which paths continue from shading points with cached light (indirect_cache.h): mirrors, facet
// lobes that the lookup has left to rays, and glass. Their directions are fixed, not random. Rays that can
// add less than contribution_threshold are left out.

#include "render/indirect/glossy_request.h"
#include "render/paths/next_ray.h"

namespace hilcam {

// Adds the rays of a shading point with cached light: one for a mirror, which may become many; those of a
// facet lobe; two for a sheet of glass. request: what the lookup has left to rays. Loop, any thread.
void add_glossy_rays(Tile& tile, const ShadingPoint& at, const GlossyRequest& request, NextRays& rays);
// Adds the next rays along a lobe that the camera sees, distributed like its reflection. at: its shading
// point. Loop, any thread.
void add_along_lobe(Tile& tile, const ShadingPoint& at, GlossyPoint& lobe, int count, NextRays& rays);
// Returns the shading point of a lobe with the members that its rays and its light need.
ShadingPoint shading_point_of(const GlossyPoint& lobe);

}  // namespace hilcam
