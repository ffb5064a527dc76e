#pragma once
// A primitive of a glTF mesh: its triangles and vertices at rest, in the mesh's axes, however they are
// stored.

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
    std::vector<Vec2f> uvs;  // transformed coordinates on the surface's textures; may be empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    // Per vertex, sets of four joints and their weights; empty: the part moves with its node only.
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<GltfNumbers> weights;
};

// Returns the number of triangles; 0 for points and lines.
std::uint64_t count_triangles(const GltfDocument& document, const GltfDocument::Json& primitive);
// Returns a primitive's material; nothing: the default.
std::optional<std::uint64_t> material_of(const GltfDocument& document, const GltfDocument::Json& primitive);
// Reads a primitive that has triangles. weights: of its morph targets. name: the mesh's, for messages. What
// it leaves out goes to looks.left_out. Throws InputError, one line, for what is missing or inconsistent.
GltfPart read_gltf_part(GltfDocument& document, const GltfDocument::Json& primitive,
                        std::span<const float> weights, GltfLooks& looks, const std::string& name);

}  // namespace hilcam
