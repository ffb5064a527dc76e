#pragma once
// Names of bodies, spacecraft and instruments, and NAIF's codes for them.

#include <optional>
#include <string>
#include <string_view>

#include "io/spice/kernel_pool.h"

namespace hilcam {

// Returns the code of a name; a number stands for itself. The kernels' NAIF_BODY_NAME and NAIF_BODY_CODE take
// precedence over the built-in names: the Sun, barycentres, planets, larger moons, some asteroids and comets
// (NAIF, "NAIF IDs Required Reading"). Case does not matter, and underscores count as blanks. Nothing for an
// unknown name.
std::optional<int> kernel_code(const KernelPool& pool, std::string_view name);
// Returns the same. Throws InputError, which says what the name is for.
int require_kernel_code(const KernelPool& pool, std::string_view name, const std::string& key);

}  // namespace hilcam
