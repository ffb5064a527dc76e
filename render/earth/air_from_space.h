#pragma once
// An atmosphere that looks up rays from space in a table (air_columns.h) and leaves everything else to the
// original. For scenes in which the Earth is a plain body; the Earth's model has such a table itself.

#include <memory>

#include "render/sky/atmosphere.h"

namespace hilcam {

// Computes the table on all threads, about 0.4 core-seconds for `precomputed`. air: not null.
std::unique_ptr<Atmosphere> looked_up_from_space(std::unique_ptr<Atmosphere> air);

}  // namespace hilcam
