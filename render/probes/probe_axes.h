#pragma once
// The directions of a probe in body axes. Inline, because the tracing of a table calls it for each ray.

#include "render/brdf/microfacet.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns one of transfer_directions() in a probe's axes. probe: frame about the probe's mean normal, body
// axes; turn: the probe's own rotation about that normal [cos, sin].
inline Vec3f probe_direction(const Frame& probe, Vec2f turn, Vec3f local) {
    return probe.to_world(
        {turn.x * local.x - turn.y * local.y, turn.y * local.x + turn.x * local.y, local.z});
}

}  // namespace hilcam
