#pragma once
// A probe's directions in body axes. Inline: used for each ray of a table while it is made.

#include "render/brdf/microfacet.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns one of transfer_directions() as a probe looks along it. probe: frame about the probe's mean normal, body axes; turn: the
// probe's own turn about that normal [cos, sin].
inline Vec3f probe_direction(const Frame& probe, Vec2f turn, Vec3f local) {
    return probe.to_world(
        {turn.x * local.x - turn.y * local.y, turn.y * local.x + turn.x * local.y, local.z});
}

}  // namespace hilcam
