#pragma once
// The program's own atmospheres (see atmosphere.h).

#include <memory>

#include "render/sky/atmosphere.h"

namespace hilcam {

// Throws InputError when a parameter or a table does not fit.
std::unique_ptr<Atmosphere> make_precomputed_atmosphere(const AtmosphereRequest& request);
std::unique_ptr<Atmosphere> make_table_atmosphere(const AtmosphereRequest& request);

}  // namespace hilcam
