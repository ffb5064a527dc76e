#pragma once
// An atmosphere whose rays from space are looked up in a table (air_columns.h) instead of being worked out; all else is the
// atmosphere's own. For scenes in which the Earth is a plain body: the Earth's model has such a table itself.

#include <memory>

#include "render/sky/atmosphere.h"

namespace hilcam {

// Works the table out on all threads, some 0.4 core-seconds for `precomputed`. air: not null.
std::unique_ptr<Atmosphere> looked_up_from_space(std::unique_ptr<Atmosphere> air);

}  // namespace hilcam
