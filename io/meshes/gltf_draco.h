#pragma once
// Decompresses primitives of glTF's extension KHR_draco_mesh_compression. The only unit that knows Draco.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/gltf_accessor.h"

namespace hilcam {

struct DracoPrimitive {
    std::vector<std::uint32_t> indices;             // three to a triangle
    std::map<std::string, GltfNumbers> attributes;  // by glTF name, all of one length
};

// attributes: Draco's attribute numbers by glTF name; other attributes are left out. Throws InputError, the
// rest of a sentence that begins with the primitive's name.
DracoPrimitive unpack_draco(std::span<const std::uint8_t> packed,
                            const std::map<std::string, std::uint32_t>& attributes);

}  // namespace hilcam
