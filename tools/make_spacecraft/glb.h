#pragma once
// Writes surfaces as binary glTF 2.0: a node per part, a primitive per material, indexed triangles with
// normals.

#include <filesystem>
#include <map>
#include <string>

#include "tools/make_spacecraft/patch.h"

namespace spacecraft {

// part -> material -> surface
using Parts = std::map<std::string, std::map<std::string, Surface>>;

// Writes beside the target first and renames, so that a reader never sees half a file. Throws
// std::runtime_error.
void write_glb(const std::filesystem::path& file, const Parts& parts);

}  // namespace spacecraft
