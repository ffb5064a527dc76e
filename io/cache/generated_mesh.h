#pragma once
// Meshes that a generator program makes when they are first used. The cache keeps them under names that
// encode the arguments.

#include <string>
#include <vector>

#include "io/cache/cache.h"

namespace hilcam {

// Returns the file name for `program` with `arguments`. Throws InputError when `program` is not a program's
// name.
std::string generated_mesh_name(const std::string& program, const std::vector<std::string>& arguments);

// Returns the mesh that `program` makes with `arguments` ("--triangles", "3000000", ...) and "--out FILE";
// runs it if the cache does not have the file. The program is the one of that name beside this executable; no
// shell is involved. Throws InputError when it is missing or refuses its arguments, DeviceError when it fails
// or the file cannot be written.
HeldFile generated_mesh(const std::string& program, const std::vector<std::string>& arguments,
                        const Cache& cache);

}  // namespace hilcam
