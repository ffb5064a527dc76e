#pragma once
// A primitive of a glTF mesh: its triangles and vertices as they are at rest, in the mesh's own axes, by whatever means they are stored.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/gltf_accessor.h"
#include "io/meshes/gltf_document.h"
#include "io/meshes/gltf_looks.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

struct GltfPart {
    std::size_t surface = 0;
    std::vector<Vec3f> places, normals, colors;  // one per vertex; the last two may be empty
    std::vector<Vec2f> uvs;                      // places on the surface's textures, moved; may be empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // Sets of four joints and their weights per vertex; empty: it hangs on its node alone.
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<GltfNumbers> weights;
};

// Returns how many triangles a primitive has; 0 where it has points or lines.
std::uint64_t count_triangles(const GltfDocument& document, const GltfDocument::Json& primitive);
// Returns a primitive's material; nothing: it has the default.
std::optional<std::uint64_t> material_of(const GltfDocument& document, const GltfDocument::Json& primitive);
// Reads a primitive that has triangles. weights: of its morph targets. InputError, one line, for what is not there or does not
// fit; what it leaves out is told to `looks`. name: the mesh's, for messages.
GltfPart read_gltf_part(GltfDocument& document, const GltfDocument::Json& primitive,
                        std::span<const float> weights, GltfLooks& looks, const std::string& name);

}  // namespace hilcam
