#pragma once
// Names of bodies, spacecraft and instruments and NAIF's codes for them.

#include <optional>
#include <string>
#include <string_view>

#include "io/spice/kernel_pool.h"

namespace hilcam {

// Returns the code of a name, or of a number that stands for itself. The kernels' NAIF_BODY_NAME and NAIF_BODY_CODE come
// before the program's own names: the Sun, barycentres, planets, larger moons, some asteroids and comets (NAIF, "NAIF IDs
// Required Reading"). Upper and lower case, blanks and underscores are the same. None: it is no such name.
std::optional<int> kernel_code(const KernelPool& pool, std::string_view name);
// The same; throws InputError, which says what the name is for.
int require_kernel_code(const KernelPool& pool, std::string_view name, const std::string& key);

}  // namespace hilcam
