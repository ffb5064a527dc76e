#pragma once
// The Sun and bodies from SPICE kernels, for the sky (render/sky/body_source.h).

#include <memory>
#include <string>
#include <vector>

#include "io/spice/spice_kernels.h"
#include "render/sky/body_source.h"

namespace hilcam {

// Returns NAIF's code of a body; without a body, the Sun's.
int naif_code(const std::optional<BodyId>& body);
// Returns the same code, or that of the body's barycentre where the kernels have only that. For Mercury,
// Venus and Mars the two are less than a metre apart.
int naif_code_in(const SpiceKernels& kernels, const std::optional<BodyId>& body);

// Uses what the kernels cover at `start`: places of bodies relative to the Sun, and rotations from
// OBJECT_<code>_FRAME or IAU_<body> (for the Earth only from a binary kernel, as the text kernel has no
// nutation). Outside their spans the program's own series apply. origin: NAIF code of an origin of kind
// spice, or none. Throws InputError when that origin is not covered at `start`.
std::shared_ptr<const BodySource> make_spice_sky(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::optional<int>& origin, bool with_bodies,
                                                 TimeTai start);

}  // namespace hilcam
