#pragma once
// The Sun and bodies as SPICE's kernels have them, for the sky (render/sky/body_source.h).

#include <memory>
#include <string>
#include <vector>

#include "io/spice/spice_kernels.h"
#include "render/sky/body_source.h"

namespace hilcam {

// NAIF's code of a body, the Sun's for none.
int naif_code(const std::optional<BodyId>& body);
// The same, or its barycentre's where the kernels have that alone; of Mercury, Venus and Mars both are within a metre.
int naif_code_in(const SpiceKernels& kernels, const std::optional<BodyId>& body);

// Takes what the kernels know at `start`: places of bodies about the Sun, and turns by the body's OBJECT_<code>_FRAME or
// IAU_<body> (the Earth: by a binary kernel alone, as the text one leaves nutation out). Outside their spans the program's
// own series count. origin: thing that an origin of kind spice belongs to, or none. Throws InputError for that when it is not
// known at `start`.
std::shared_ptr<const BodySource> make_spice_sky(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::optional<int>& origin, bool with_bodies,
                                                 TimeTai start);

}  // namespace hilcam
