#pragma once
// Meshes that a generator program makes at first use, kept in the cache under a name that tells its arguments.

#include <string>
#include <vector>

#include "io/cache/cache.h"

namespace hilcam {

// Returns the name of the file of `program` run with `arguments`. Throws InputError when `program` is no
// program's name.
std::string generated_mesh_name(const std::string& program, const std::vector<std::string>& arguments);

// The file of `program` run with `arguments` ("--triangles", "3000000", ...) and "--out FILE", made now if
// the cache does not have it. The program is the one of that name beside this executable; no shell is
// involved. Throws InputError when it is missing or refuses its arguments, DeviceError when it fails or the
// file cannot be written.
HeldFile generated_mesh(const std::string& program, const std::vector<std::string>& arguments,
                        const Cache& cache);

}  // namespace hilcam
