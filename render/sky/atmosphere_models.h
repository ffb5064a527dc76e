#pragma once
// The program's own atmospheres (atmosphere.h).

#include <memory>

#include "render/sky/atmosphere.h"

namespace hilcam {

// Throws InputError if a parameter or a table is not valid.
std::unique_ptr<Atmosphere> make_precomputed_atmosphere(const AtmosphereRequest& request);
std::unique_ptr<Atmosphere> make_table_atmosphere(const AtmosphereRequest& request);

}  // namespace hilcam
